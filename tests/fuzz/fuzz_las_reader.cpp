// Any bytes as a LAS file: open it, read everything, and pack it again into the records it was (LAZ:
// fuzz_laz).
#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/record_codec.hpp"

#include <cstdlib>

using namespace stipple;

namespace {

void require(bool condition) {
    if (!condition)
        std::abort();
}

// Packs the points into records again: they must be those of the file.
void requireSameRecords(const las::Reader& reader, const Bytes& file, const PointBatch& points) {
    const las::Header& header = reader.header();
    las::RecordLayout layout = las::baseLayout(header.pointFormat);
    std::vector<las::ColumnField> columns;
    const Schema& schema = reader.schema();
    for (const las::RecordField& field : layout.fields)
        columns.push_back({field.attribute, field});
    for (std::size_t a = layout.fields.size(); a < schema.attributes.size(); ++a) {
        std::size_t size = schema.attributes[a].size();
        columns.push_back({a, {a, layout.recordLength, size, 0, 0}});
        layout.recordLength += size;
    }
    require(layout.recordLength == header.recordLength);
    Bytes records(points.size() * layout.recordLength);
    require(las::packRecords(layout, columns, schema, points, 0, points.size(), records.data()).ok());
    require(records.empty() ||
            std::memcmp(records.data(), file.data() + header.pointDataOffset, records.size()) == 0);
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    Bytes file(data, data + size);
    MemorySource source(file);
    auto reader = las::Reader::open(source);
    if (!reader.ok()) {
        require(!reader.error().sentence().empty());
        return 0;
    }
    PointBatch points;
    if ((*reader)->header().compressed)
        return 0;
    require((*reader)->read(0, (*reader)->pointCount(), points).ok());
    requireSameRecords(**reader, file, points);
    return 0;
}
