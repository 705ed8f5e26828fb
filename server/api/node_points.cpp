#include "server/api/node_points.hpp"

#include "converter/crs/crs.hpp"
#include "converter/export/format_sink.hpp"
#include "converter/export/json_sink.hpp"
#include "server/api/point_formats.hpp"
#include "shared/base/text.hpp"
#include "shared/sinks/encode_pieces.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

Result<PointBatch> readPoints(const CloudVersion& cloud, const NodeEntry& entry, const NodePart& part,
                              ByteSource& source, const WorkGate& gate) {
    NodeBytes node{entry, part.attributes, {}, part.strata};
    for (const ByteRange& range : storedRanges(cloud.metadata, entry, part)) {
        STIPPLE_TRY(bytes, readNow(source, range));
        node.bytes.insert(node.bytes.end(), bytes.begin(), bytes.end());
    }
    return decodeNode(cloud.metadata, node, &gate);
}

// The members of the JSON document before the points.
std::string jsonHead(const NodeFile& file, const CloudVersion& cloud, const NodeEntry& entry,
                     const NodePart& part) {
    nlohmann::ordered_json head{{"id", file.cloudId},
                                {"version", cloud.version()},
                                {"key", entry.key.text()},
                                {"pointCount", entry.pointCount},
                                {"strata", part.strata}};
    std::string text = head.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    return cat(text.substr(1, text.size() - 2), ",");
}

BoxI boundsOf(const PointBatch& points) {
    BoxI box;
    for (const Vec3i& position : points.positions)
        box.extend(position);
    return box;
}

Result<std::unique_ptr<PointSink>> openSink(const NodeFile& file, const CloudVersion& cloud,
                                            const NodeEntry& entry, const NodePart& part,
                                            const PointBatch& points, Bytes& to) {
    auto bytes = std::make_unique<MemorySink>(to);
    SinkInput input{cloud.metadata, part.attributes};
    auto format = exportFormatOf(file.format);
    if (!format)
        return jsonSink(std::move(bytes), input, jsonHead(file, cloud, entry, part));
    FormatPlan plan;
    plan.format = *format;
    plan.pointCount = points.size();
    if (format == ExportFormat::las || format == ExportFormat::laz) {
        STIPPLE_TRY(las, LasPlan::make(input, boundsOf(points), points.size(), format == ExportFormat::laz,
                                       wktOfEpsg));
        plan.las = std::move(las);
    }
    STIPPLE_TRY(made, openFormatSink(plan, std::move(bytes), input));
    return std::move(made.sink);
}

} // namespace

Result<std::string> nodeFile(const NodeFile& file, const CloudVersion& cloud, const NodeEntry& entry,
                             const NodePart& part, ByteSource& source, const WorkGate& gate) {
    if (std::uint32_t count = strataPrefixPoints(entry.pointCount, part.strata); count > maxDecodedPoints)
        return Error{ErrorCode::limitExceeded,
                     cat("this part of the node has ", count, " points, and at most ", maxDecodedPoints,
                         " are decoded at once; ask for fewer strata, or as stored"),
                     "", ""};
    STIPPLE_TRY(points, readPoints(cloud, entry, part, source, gate));
    Bytes bytes;
    STIPPLE_TRY(sink, openSink(file, cloud, entry, part, points, bytes));
    std::size_t count = points.size();
    STIPPLE_CHECK(encodeInPieces(*sink, std::move(points), count, &gate,
                                 [&](EncodedPoints encoded) { return sink->write(std::move(encoded)); }));
    STIPPLE_CHECK(sink->finish());
    return std::string(bytes.begin(), bytes.end());
}

} // namespace stipple::server
