// Damaged LAZ files: an error or points, never a crash, and memory in proportion to the file.
#include "tests/support/byte_values.hpp"
#include "tests/support/mutate.hpp"
#include "tests/unit/shared/las/allocation_meter.hpp"
#include "tests/unit/shared/las/laz/laz_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr std::size_t samplePoints = 60;

// Small files of both kinds, with several chunks and a table.
Bytes sample(int pointFormat, bool variable) {
    LazRecipe recipe = lazRecipe(pointFormat, 3, samplePoints, variable ? las::laz::variableChunkSize : 25);
    recipe.variableChunks = {10, 30, 20};
    return lazBytes(recipe, smoothRecords(pointFormat, 3, samplePoints));
}

struct Answer {
    bool opened = false, read = false;
    PointBatch points;
};

// Opens and reads a file of unknown bytes. Most memory is what the models of the codecs take.
Answer requireSane(const Bytes& bytes) {
    MemorySource source(bytes);
    const std::size_t before = allocatedBytes();
    Answer answer;
    auto reader = las::Reader::open(source);
    if (!reader.ok()) {
        REQUIRE(!reader.error().what.empty());
        REQUIRE(!reader.error().where.empty());
        return answer;
    }
    answer.opened = true;
    const std::uint64_t count = std::min<std::uint64_t>((*reader)->pointCount(), 2 * samplePoints);
    Status read = (*reader)->read(0, count, answer.points);
    answer.read = read.ok();
    if (read.ok()) {
        REQUIRE(answer.points.size() == count);
    } else {
        REQUIRE(!read.error().what.empty());
        REQUIRE(read.error().where.find(source.name()) == 0);
        REQUIRE(answer.points.size() == 0);
    }
    REQUIRE(allocatedBytes() - before < 24 * 1024 * 1024 + 64 * bytes.size());
    return answer;
}

std::size_t pointDataOffset(const Bytes& file) {
    return loadLe<std::uint32_t>(file.data() + atPointDataOffset);
}

} // namespace

TEST_CASE("a LAZ file cut after any byte gives an error, or its points one chunk after the other", "[laz]") {
    for (int format : {3, 7}) {
        const Bytes whole = sample(format, false);
        const PointBatch points = requireLas(whole).points;
        const auto tableOffset =
            static_cast<std::size_t>(loadLe<std::uint64_t>(whole.data() + pointDataOffset(whole)));
        for (std::size_t length = 0; length < whole.size(); ++length) {
            CAPTURE(format, length);
            Answer answer =
                requireSane(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)));
            // Pointwise chunks show their end only when they are decoded; layered ones are counted before.
            if (format == 3 && length > pointDataOffset(whole) + 8 && length < tableOffset)
                REQUIRE_FALSE(answer.read);
            if (length >= tableOffset) {
                REQUIRE(answer.read);
                REQUIRE(answer.points.columns == points.columns);
            }
        }
    }
}

TEST_CASE("any value of any byte of the LASzip record is answered", "[laz]") {
    for (int format : {5, 10}) {
        const Bytes whole = sample(format, false);
        const PointBatch points = requireLas(whole).points;
        const std::size_t record = pointDataOffset(whole) - 34 - 6 * (format == 5 ? 5 : 4);
        for (std::size_t at = record; at < pointDataOffset(whole); ++at)
            for (std::uint8_t value : everyDamage(whole[at])) {
                CAPTURE(format, at - record, value);
                Bytes bytes = whole;
                bytes[at] = value;
                Answer answer = requireSane(bytes);
                // Versions, options and special records (bytes 4-11 and 16-31) say nothing about the points.
                const std::size_t place = at - record;
                if ((place >= 4 && place < 12) || (place >= 16 && place < 32)) {
                    REQUIRE(answer.read);
                    REQUIRE(answer.points.columns == points.columns);
                }
            }
    }
}

TEST_CASE("any value of any byte of the chunk table gives the points or an error", "[laz]") {
    for (bool variable : {false, true})
        for (int format : {1, 8}) {
            const Bytes whole = sample(format, variable);
            const PointBatch points = requireLas(whole).points;
            const std::size_t front = pointDataOffset(whole);
            const auto table = static_cast<std::size_t>(loadLe<std::uint64_t>(whole.data() + front));
            std::size_t recovered = 0, tried = 0;
            for (std::size_t i = 0; i < 8 + whole.size() - table; ++i) {
                const std::size_t at = i < 8 ? front + i : table + i - 8;
                for (std::uint8_t value : everyDamage(whole[at])) {
                    CAPTURE(variable, format, i, value);
                    Bytes bytes = whole;
                    bytes[at] = value;
                    ++tried;
                    Answer answer = requireSane(bytes);
                    const bool same = answer.read && answer.points.columns == points.columns;
                    recovered += same;
                    // With chunks of a fixed number of points, or layered ones, the table can be done
                    // without, unless it is believed: then its chunks do not fit.
                    if (i < 8 + 8 && (format == 8 || !variable))
                        REQUIRE((same || (answer.opened && i >= 8)));
                }
            }
            CAPTURE(variable, format, recovered, tried);
            CHECK(recovered * 100 > tried * (variable && format == 1 ? 7 : 14));
        }
}

TEST_CASE("damaged chunks give errors or points", "[laz]") {
    for (int format = 0; format <= 10; ++format) {
        LazRecipe recipe = lazRecipe(format, 3, samplePoints, 25);
        const Bytes whole = lazBytes(recipe, smoothRecords(format, 3, samplePoints));
        const Bytes first =
            format <= 5 ? lazBytes(firstVersion(recipe), smoothRecords(format, 3, samplePoints)) : Bytes{};
        for (std::uint64_t seed = 0; seed < damages(300); ++seed) {
            CAPTURE(format, seed);
            requireSane(mutate(whole, seed).bytes);
            if (format <= 5)
                requireSane(mutate(first, seed).bytes);
        }
        // Of chunks alone, with the file's frame as it was.
        std::mt19937 random(static_cast<std::uint32_t>(format));
        const std::size_t front = pointDataOffset(whole) + 8;
        for (int run = 0; run < damages(300); ++run) {
            Bytes bytes = whole;
            for (int change = 0; change < 1 + run % 20; ++change)
                bytes[front + random() % (bytes.size() - front)] = static_cast<std::uint8_t>(random());
            requireSane(bytes);
        }
    }
}

TEST_CASE("most damage to pointwise chunks is noticed", "[laz]") {
    const Bytes whole = sample(2, false);
    const std::size_t front = pointDataOffset(whole) + 8;
    const auto table = static_cast<std::size_t>(loadLe<std::uint64_t>(whole.data() + front - 8));
    std::size_t damaged = 0, noticed = 0;
    for (std::size_t at = front + 29; at < table; at += 3) { // behind the first record
        Bytes bytes = whole;
        bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 0x10);
        ++damaged;
        noticed += !requireSane(bytes).read;
    }
    CAPTURE(damaged, noticed);
    CHECK(noticed * 10 > damaged * 3);
}

TEST_CASE("a header that counts more points than there are is answered with those there are", "[laz]") {
    for (int format : {2, 7}) {
        CAPTURE(format);
        Bytes bytes = sample(format, true);
        const PointBatch points = requireLas(bytes).points;
        if (format == 2)
            storeLe(bytes.data() + atLegacyCount, 0xFFFFFFFFu);
        else
            storeLe(bytes.data() + atCount, ~0ull);
        LasContents contents = requireLas(bytes);
        CHECK(contents.points.size() == samplePoints);
        CHECK(contents.points.columns == points.columns);
        CHECK(anyContains(contents.warnings, "but the chunk table has only 60"));
        // One of fixed chunks may have as many as fit into its last chunk: that turns out later.
        Bytes fixed = sample(format, false);
        if (format == 2)
            storeLe(fixed.data() + atLegacyCount, 75u);
        else
            storeLe(fixed.data() + atCount, std::uint64_t{75});
        CHECK_FALSE(requireSane(fixed).read);
    }
}

TEST_CASE("a lying count of points in one stream is no reason to make room for them", "[laz]") {
    LazRecipe recipe = lazRecipe(0, 0, samplePoints, 0);
    recipe.record.compressor = las::laz::Compressor::pointwise;
    Bytes bytes = lazBytes(recipe, smoothRecords(0, 0, samplePoints));
    storeLe(bytes.data() + atLegacyCount, std::uint32_t{500'000});
    MemorySource source(bytes);
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    const std::size_t before = allocatedBytes();
    PointBatch points;
    CHECK((*reader)->read(0, 500'000, points).error().code == ErrorCode::truncated);
    CHECK(allocatedBytes() - before < 128 * 1024 * 1024);
    // More than any so many bytes can hold:
    storeLe(bytes.data() + atLegacyCount, 0xFFFFFFFFu);
    MemorySource more(bytes);
    CHECK(las::Reader::open(more).error().code == ErrorCode::corrupt);
}

TEST_CASE("ten million equal points are fewer to a byte than what is taken for a lie", "[laz]") {
    LazRecipe recipe = lazRecipe(0, 0, 0, las::laz::variableChunkSize);
    auto encoder = las::laz::makePointwiseEncoder(recipe.record.items);
    encoder->start();
    const Bytes records(20 * 10000, 7);
    for (int i = 0; i < 1000; ++i)
        encoder->encode(records);
    CHECK(encoder->finish().size() > 10'000'000 / 1000);
}
