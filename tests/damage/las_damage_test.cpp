// Thousands of damaged LAS files. LAS has no checksums, so a flipped bit inside a point record is another
// value of that record; what is asked for is: no crash, no hang, bounded memory, and every point that the
// damage did not touch is as it was.
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/damage/sample_points.hpp"
#include "tests/support/allocation_meter.hpp"
#include "tests/support/mutate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>

using namespace stipple;

namespace {

constexpr std::size_t memoryBound = 16u << 20; // for files of about 20 kB
constexpr double secondsBound = 5;

struct Original {
    Bytes bytes;
    PointBatch points;
    Schema schema;
    std::size_t pointsOffset = 0, recordLength = 0;
};

Result<PointBatch> readAll(const Bytes& bytes, las::Header* header = nullptr) {
    MemorySource source(bytes, "damaged.las");
    STIPPLE_TRY(reader, las::Reader::open(source));
    if (header != nullptr)
        *header = reader->header();
    PointBatch all;
    if (reader->pointCount() > bytes.size())
        return Error{ErrorCode::corrupt, "more points than bytes", "test", ""};
    STIPPLE_CHECK(reader->read(0, reader->pointCount(), all));
    return all;
}

Original makeLas(int format) {
    Original original;
    las::WriterOptions options;
    options.schema = las::schemaOf(format);
    options.pointFormat = format;
    Attribute extra;
    extra.name = "Amplitude";
    extra.type = AttributeType::u16;
    options.schema.attributes.push_back(extra);
    original.schema = options.schema;
    auto path = (std::filesystem::temp_directory_path() / "stipple_damage_test.las").string();
    auto writer = las::Writer::create(path, options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(test::samplePoints(options.schema, 300, 20, 3)).ok());
    REQUIRE((*writer)->finish().ok());
    writer->reset();
    auto source = openFileSource(path);
    REQUIRE(source.ok());
    original.bytes = *readNow(**source, {0, (*source)->sizeBytes()});
    std::filesystem::remove(path);
    las::Header header;
    auto points = readAll(original.bytes, &header);
    REQUIRE(points.ok());
    REQUIRE(points->size() == 300);
    original.points = std::move(*points);
    original.pointsOffset = header.pointDataOffset;
    original.recordLength = header.recordLength;
    return original;
}

bool samePoint(const Original& original, const PointBatch& read, std::size_t i) {
    if (!(read.positions[i] == original.points.positions[i]))
        return false;
    for (std::size_t a = 0; a < original.schema.attributes.size(); ++a) {
        std::size_t size = original.schema.attributes[a].size();
        if (std::memcmp(read.columns[a].data() + i * size, original.points.columns[a].data() + i * size,
                        size) != 0)
            return false;
    }
    return true;
}

// Damage that lies behind the header and records leaves every point before it, and, if nothing was shifted,
// after it.
std::size_t requireUntouchedPoints(const Original& original, const test::Mutation& mutation,
                                   const PointBatch& read) {
    std::size_t compared = 0;
    REQUIRE(read.columns.size() == original.schema.attributes.size());
    for (std::size_t i = 0; i < std::min(read.size(), original.points.size()); ++i) {
        std::size_t first = original.pointsOffset + i * original.recordLength,
                    end = first + original.recordLength;
        if (end <= mutation.firstTouched || (mutation.sameSize && first >= mutation.endTouched)) {
            REQUIRE(samePoint(original, read, i));
            ++compared;
        }
    }
    return compared;
}

void tryDamagedFiles(std::uint64_t perFormat) {
    std::size_t errors = 0, answers = 0, compared = 0, highest = 0;
    for (int format = 0; format <= 10; ++format) {
        Original original = makeLas(format);
        for (std::uint64_t seed = 0; seed < perFormat; ++seed) {
            test::Mutation mutation =
                test::mutate(original.bytes, seed * 11 + static_cast<std::uint64_t>(format));
            INFO("format " << format << ", seed " << seed << ", " << mutation.what);
            auto start = std::chrono::steady_clock::now();
            test::resetAllocationPeak();
            auto points = readAll(mutation.bytes);
            highest = std::max(highest, test::allocationPeak());
            REQUIRE(test::allocationPeak() < memoryBound);
            REQUIRE(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
                    secondsBound);
            ++(points.ok() ? answers : errors);
            if (points.ok() && mutation.firstTouched >= original.pointsOffset)
                compared += requireUntouchedPoints(original, mutation, *points);
        }
    }
    REQUIRE(errors > 0);
    REQUIRE(compared > 100 * perFormat);
    WARN(11 * perFormat << " damaged LAS files: " << errors << " errors, " << answers << " answers, "
                        << compared << " untouched points compared, most memory " << highest << " bytes");
}

} // namespace

TEST_CASE("a damaged LAS file gives an error or its untouched points") {
    tryDamagedFiles(300);
}
TEST_CASE("many damaged LAS files give errors or their untouched points", "[slow]") {
    tryDamagedFiles(5000);
}
