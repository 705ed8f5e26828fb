// A whole .stipple file. Checksums would stop nearly every mutation at the door, so besides the file as it is
// its payloads are tried as metadata and as a hierarchy chunk under checksums that fit.
#include "shared/format/block_frame.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"

#include <cstdlib>

namespace {

using namespace stipple;

Status readAll(const Bytes& bytes) {
    MemorySource source(bytes);
    STIPPLE_TRY(reader, CloudReader::open(source));
    return reader->visitNodes([&](const NodeEntry& entry) -> Status {
        STIPPLE_TRY(points, reader->readNode(entry));
        if (points.size() != entry.pointCount)
            std::abort();
        return {};
    });
}

void parsePayloads(ByteSpan payload) {
    (void)parseMetadata(frameBlock(payload));
    CloudMetadata metadata;
    metadata.rootCube.bits = 20;
    metadata.schema.attributes.resize(2);
    metadata.schema.attributes[1].name = "second";
    constexpr std::uint64_t fileBytes = 1 << 20;
    auto nodes = parseHierarchyChunk(metadata, fileBytes, frameBlock(payload));
    if (!nodes.ok())
        return;
    for (const NodeEntry& node : *nodes)
        if (node.offsetBytes + node.sizeBytes() > fileBytes || node.childChunk.end() > fileBytes)
            std::abort(); // a range outside the file
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    ByteSpan bytes(data, size);
    (void)readAll(Bytes(bytes.begin(), bytes.end()));
    parsePayloads(bytes);
    return 0;
}
