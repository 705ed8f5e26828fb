// The viewer's scans of regions.
#include "client/core/json.hpp"
#include "client/web/region_messages.hpp"
#include "client/web/viewer.hpp"
#include "shared/base/json_fields.hpp"
#include "shared/select/region_json.hpp"

#include <nlohmann/json.hpp>

namespace stipple::web {

namespace {
constexpr std::size_t maxScannedAttributes = 4096;
}

Bytes Viewer::metadataOf(CloudId id) const {
    return session_->metadataBlock(id);
}

Result<RegionScanId> Viewer::scanRegion(std::string_view text) {
    STIPPLE_TRY(request, parseJson(text, "scan"));
    RegionRequest wanted;
    json_fields::FieldReader fields(request, "scan");
    fields.number("cloud", wanted.cloud, 0, 0xffffffff);
    fields.allow("region");
    fields.list(
        "attributes", maxScannedAttributes,
        [&](const nlohmann::json& item, const std::string& path) -> Status {
            if (!item.is_number_integer())
                return Error{ErrorCode::invalidArgument, say("attributes are told by their index"), path, ""};
            wanted.attributes.push_back(item.get<int>());
            return {};
        });
    STIPPLE_CHECK(fields.finish());
    STIPPLE_TRY(filter,
                regionFromJson(request.contains("region") ? request["region"] : nlohmann::json::object(),
                               "scan.region"));
    wanted.filter = std::move(filter);
    return session_->scanRegion(wanted);
}

std::optional<std::pair<Bytes, Bytes>> Viewer::takeRegionNode(RegionScanId id) {
    std::vector<RegionNode> nodes = session_->takeRegionNodes(id, 1);
    if (nodes.empty())
        return std::nullopt;
    Bytes message = encodeRegionNode(nodes[0]);
    return std::pair(std::move(message), std::move(nodes[0].node.bytes));
}

std::string Viewer::regionProgressJson(RegionScanId id) const {
    RegionProgress progress = session_->regionProgress(id);
    return jsonText({{"nodesDone", progress.nodesDone},
                     {"nodesToDo", progress.nodesToDo},
                     {"pointsDone", progress.pointsDone},
                     {"pointsToDo", progress.pointsToDo},
                     {"nodesOutside", progress.nodesOutside},
                     {"chunksToDo", progress.chunksToDo},
                     {"bytesRead", progress.bytesRead},
                     {"hierarchyKnown", progress.hierarchyKnown},
                     {"complete", progress.complete},
                     {"error", progress.error ? nlohmann::json(progress.error->said()) : nullptr}});
}

void Viewer::endRegionScan(RegionScanId id) {
    session_->endRegionScan(id);
}

} // namespace stipple::web
