// A whole small file, written to a temporary place and read into memory.
#pragma once

#include "shared/io/file_source.hpp"
#include "tests/unit/shared/format/sample_cloud.hpp"

#include <algorithm>
#include <filesystem>

namespace stipple::test {

inline std::string temporaryPath(const std::string& name) {
    return (std::filesystem::temp_directory_path() / ("stipple-test-" + name + ".stipple")).string();
}

struct SampleFile {
    Bytes bytes;
    PointHash hash;
    CloudMetadata metadata;
    WrittenCloud written;
};

// Four nodes of `nodePoints` × 1…4 points on levels 0, 1 and 3, added in the order of `seed`.
inline SampleFile sampleFile(std::size_t nodePoints, std::uint32_t seed = 0) {
    SampleFile file;
    file.metadata = sampleMetadata();
    std::string path = temporaryPath("sample");
    std::vector<EncodedNode> nodes;
    for (NodeKey key : {NodeKey{}, NodeKey{1, 0, 1, 0}, NodeKey{3, 5, 2, 7}, NodeKey{1, 1, 1, 1}}) {
        std::size_t count = nodePoints * (nodes.size() + 1);
        PointBatch points = randomPoints(file.metadata, key, count, static_cast<std::uint32_t>(nodes.size()));
        file.hash.add(file.metadata.schema, points);
        file.metadata.pointCount += points.size();
        nodes.push_back(need(encodeNode(file.metadata, key, points)));
    }
    std::shuffle(nodes.begin(), nodes.end(), std::mt19937(seed));
    auto writer = need(CloudWriter::create(path));
    for (const EncodedNode& node : nodes)
        need(writer->add(node));
    file.written = need(writer->finish(file.metadata));
    auto source = need(openFileSource(path));
    file.bytes = need(readNow(*source, {0, source->sizeBytes()}));
    std::filesystem::remove(path);
    return file;
}

} // namespace stipple::test
