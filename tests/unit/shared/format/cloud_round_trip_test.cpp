#include "tests/unit/shared/format/sample_cloud.hpp"

#include "shared/io/file_source.hpp"

#include <filesystem>

using namespace stipple;
using namespace stipple::test;

namespace {

std::string temporaryPath(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("stipple-" + name + ".stipple")).string();
}

} // namespace

TEST_CASE("the points of a written cloud are read back") {
    CloudMetadata metadata = sampleMetadata();
    std::string path = temporaryPath("round-trip");
    PointHash hash;
    {
        auto writer = need(CloudWriter::create(path));
        std::uint32_t seed = 1;
        for (NodeKey key : {NodeKey{}, NodeKey{1, 0, 1, 0}, NodeKey{3, 5, 2, 7}, NodeKey{1, 1, 1, 1}}) {
            PointBatch points = randomPoints(metadata, key, 1000 * seed, seed);
            ++seed;
            hash.add(metadata.schema, points);
            metadata.pointCount += points.size();
            need(writer->add(need(encodeNode(metadata, key, points))));
        }
        need(writer->finish(metadata));
    }
    auto source = need(openFileSource(path));
    auto reader = need(CloudReader::open(*source));
    PointHash read;
    std::uint64_t points = 0, nodes = 0;
    need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(batch, reader->readNode(entry));
        read.add(reader->metadata().schema, batch);
        points += batch.size();
        ++nodes;
        return {};
    }));
    CHECK(points == metadata.pointCount);
    CHECK(nodes == 6);
    CHECK(read == hash);
    CHECK(!std::filesystem::exists(path + ".blocks"));
    CHECK(!std::filesystem::exists(path + ".part"));
    std::filesystem::remove(path);
}
