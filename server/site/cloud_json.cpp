#include "server/site/cloud_json.hpp"

#include "server/site/cloud_address.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

// Text of inputs may be in any encoding; JSON is UTF-8.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json boundsJson(const BoxD& box) {
    if (box.empty())
        return nullptr;
    return {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
}

Json summaryJson(const std::string& id, const CloudSummary& summary) {
    return {{"id", id},
            {"name", summary.name},
            {"address", cloudAddress(id)},
            {"pointCount", summary.pointCount},
            {"bounds", boundsJson(summary.bounds)},
            {"sizeBytes", summary.sizeBytes},
            {"etag", summary.etag},
            {"version", summary.version}};
}

} // namespace

std::string cloudListJson(const CloudList& list) {
    Json clouds = Json::array();
    for (const auto& [id, summary] : list.clouds)
        clouds.push_back(summaryJson(id, summary));
    Json json{{"clouds", std::move(clouds)}};
    if (!list.next.empty())
        json["next"] = list.next;
    return dump(json);
}

std::string cloudJson(const std::string& id, const CloudVersion& version) {
    Json json = summaryJson(id, summaryOf(version));
    json["metadata"] = Json::parse(version.metadataText, nullptr, false);
    return dump(json);
}

} // namespace stipple::server
