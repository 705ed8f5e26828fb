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

Json boundsJson(const CloudMetadata& metadata) {
    BoxD box = metadata.worldBounds();
    if (box.empty())
        return nullptr;
    return {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
}

Json summary(const NamedCloud& cloud) {
    const auto& [id, version] = cloud;
    return {{"id", id},
            {"name", version->metadata.name},
            {"address", cloudAddress(id)},
            {"pointCount", version->metadata.pointCount},
            {"bounds", boundsJson(version->metadata)},
            {"sizeBytes", version->sizeBytes()},
            {"etag", version->validators.etag},
            {"version", version->version()}};
}

} // namespace

std::string cloudListJson(const std::vector<NamedCloud>& clouds) {
    Json list = Json::array();
    for (const NamedCloud& cloud : clouds)
        list.push_back(summary(cloud));
    return dump({{"clouds", std::move(list)}});
}

std::string cloudJson(const NamedCloud& cloud) {
    Json json = summary(cloud);
    json["metadata"] = Json::parse(cloud.second->metadataText, nullptr, false);
    return dump(json);
}

} // namespace stipple::server
