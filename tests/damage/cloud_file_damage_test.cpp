// Thousands of damaged `.stipple` files: each gives an error or exactly the right points, within stated
// bounds of memory and time. Every block carries a checksum, so wrong points are never an acceptable answer.
#include "client/core/view_session.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "tests/damage/sample_points.hpp"
#include "tests/support/allocation_meter.hpp"
#include "tests/support/mutate.hpp"

#include <catch2/catch.hpp>

#include <chrono>
#include <filesystem>
#include <map>

using namespace stipple;

namespace {

constexpr std::size_t memoryBound = 64u << 20; // for files of about 100 kB
constexpr double secondsBound = 5;             // generous: sanitizers and a busy machine; a hang is minutes
constexpr int rootBits = 20;

Bytes readFile(const std::string& path) {
    auto source = openFileSource(path);
    REQUIRE(source.ok());
    auto bytes = readNow(**source, {0, (*source)->sizeBytes()});
    REQUIRE(bytes.ok());
    return *bytes;
}

// Two levels: the root with every 8th point, whose picture shows other colours, its children with the rest.
Bytes makeCloudFile() {
    CloudMetadata metadata;
    metadata.name = "damage";
    metadata.rootCube = {{0, 0, 0}, rootBits};
    metadata.spacing = 1;
    metadata.schema = las::schemaOf(7);
    metadata.statistics.resize(metadata.schema.attributes.size());
    metadata.pictureColour = PictureColour::rgb;
    metadata.innerColour = InnerColour::mean;
    PointBatch points = test::samplePoints(metadata.schema, 4000, rootBits, 7);
    metadata.pointCount = points.size();

    std::map<NodeKey, std::vector<std::size_t>> members;
    PointHash hash;
    hash.add(metadata.schema, points);
    metadata.pointHash = hash.hex();
    for (std::size_t i = 0; i < points.size(); ++i) {
        metadata.bounds.extend(points.positions[i]);
        members[metadata.rootCube.keyOf(points.positions[i], i % 8 == 0 ? 0 : 1)].push_back(i);
    }
    auto path = (std::filesystem::temp_directory_path() / "stipple_damage_test.stipple").string();
    auto writer = CloudWriter::create(path);
    REQUIRE(writer.ok());
    for (const auto& [key, indices] : members) {
        PointBatch node;
        node.resize(metadata.schema, indices.size());
        for (std::size_t to = 0; to < indices.size(); ++to) {
            node.positions[to] = points.positions[indices[to]];
            for (std::size_t a = 0; a < node.columns.size(); ++a) {
                std::size_t size = metadata.schema.attributes[a].size();
                std::memcpy(node.columns[a].data() + to * size, points.columns[a].data() + indices[to] * size,
                            size);
            }
        }
        std::vector<std::uint16_t> shown;
        int red = metadata.schema.find(attribute_names::red);
        for (std::size_t i = 0; key.level == 0 && i < 3 * node.size(); ++i)
            shown.push_back(node.value<std::uint16_t>(red + static_cast<int>(i % 3), i / 3) / 2);
        auto encoded = encodeNode(metadata, key, node, shown);
        REQUIRE(encoded.ok());
        REQUIRE((*writer)->add(*encoded).ok());
    }
    auto written = (*writer)->finish(metadata);
    REQUIRE(written.ok());
    writer->reset();
    Bytes bytes = readFile(path);
    std::filesystem::remove(path);
    return bytes;
}

// The hash of all points of the file, or the error met.
Result<std::string> readEverything(Bytes bytes) {
    MemorySource source(std::move(bytes), "damaged");
    STIPPLE_TRY(reader, CloudReader::open(source));
    PointHash hash;
    STIPPLE_CHECK(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(points, reader->readNode(entry));
        hash.add(reader->metadata().schema, points);
        return {};
    }));
    return hash.hex();
}

// What a viewer does with it; ends settled or failed.
bool viewUntilSettled(Bytes bytes) {
    auto decoder = makeInlineDecoder();
    auto session = ViewSession::create(*decoder);
    session->setViewport(320, 240);
    session->addCloud(std::make_unique<MemorySource>(std::move(bytes), "damaged"), "damaged");
    for (int step = 0; step < 1000; ++step) {
        session->update();
        if (session->clouds().front().stage == CloudStage::failed || session->settled())
            return true;
    }
    return false;
}

void tryDamagedFiles(std::uint64_t firstSeed, std::uint64_t count, bool view) {
    Bytes original = makeCloudFile();
    auto expected = readEverything(original);
    REQUIRE(expected.ok());
    std::size_t errors = 0, right = 0, highest = 0;
    for (std::uint64_t seed = firstSeed; seed < firstSeed + count; ++seed) {
        test::Mutation mutation = test::mutate(original, seed);
        INFO("seed " << seed << ", " << mutation.what);
        auto start = std::chrono::steady_clock::now();
        test::resetAllocationPeak();
        if (view) {
            REQUIRE(viewUntilSettled(std::move(mutation.bytes)));
        } else {
            auto hash = readEverything(std::move(mutation.bytes));
            if (hash.ok())
                REQUIRE(*hash == *expected);
            ++(hash.ok() ? right : errors);
            if (!hash.ok())
                REQUIRE_FALSE(hash.error().what.empty());
        }
        highest = std::max(highest, test::allocationPeak());
        REQUIRE(test::allocationPeak() < memoryBound);
        REQUIRE(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() <
                secondsBound);
    }
    if (!view)
        REQUIRE(errors > count / 2);
    WARN(count << " damaged files of " << original.size() << " bytes " << (view ? "viewed" : "read") << ": "
               << errors << " errors, " << right << " right, most memory " << highest << " bytes");
}

} // namespace

TEST_CASE("a damaged cloud file gives an error or the right points") {
    tryDamagedFiles(0, 1500, false);
}
TEST_CASE("a viewer of a damaged cloud file settles") {
    tryDamagedFiles(50'000, 300, true);
}
TEST_CASE("many damaged cloud files give errors or the right points", "[slow]") {
    tryDamagedFiles(100'000, 30'000, false);
    tryDamagedFiles(200'000, 10'000, true);
}
