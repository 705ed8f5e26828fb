// What the viewer's picture shows at a place, from the pixel to the point's record.
#include "client/web/viewer.hpp"

#include "client/core/cloud_facts.hpp"
#include "client/core/json.hpp"
#include "client/core/point_query.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <utility>

namespace stipple::web {
namespace {

PointIdentity identityOf(const PickHit& hit) {
    return {hit.cloud, hit.node->key, hit.point};
}

// What measuring from a point needs to know of its cloud.
void addPlace(nlohmann::json& point, const CloudState& cloud, const PointIdentity& identity) {
    if (!cloud.metadata)
        return;
    const CloudMetadata& metadata = *cloud.metadata;
    const Crs& crs = metadata.crs;
    auto list = [](Vec3d v) { return nlohmann::json{v.x, v.y, v.z}; };
    point["crs"] = crs.name;
    point["epsg"] = crs.epsg ? nlohmann::json(*crs.epsg) : nlohmann::json(nullptr);
    point["unit"] = crs.unit;
    point["unitMeters"] = crs.unitMeters;
    point["geocentric"] = isGeocentric(crs);
    point["scale"] = list(metadata.grid.scale);
    point["offset"] = list(metadata.grid.offset);
    point["spacing"] = std::ldexp(metadata.spacing, -identity.node.level);
}

std::string pickError(const Error& error) {
    return jsonText({{"pending", false}, {"error", error.said()}});
}

} // namespace

Status Viewer::pick(double x, double y, int radius) {
    picked_.reset();
    if (!renderer_ || drawn_.width == 0)
        return Error{ErrorCode::invalidArgument, say("there is no picture yet"), "", ""};
    return renderer_->startPick(drawn_, {x, y, radius});
}

nlohmann::json Viewer::pickedJson(const PickHit& hit, const PointRecord& record) const {
    nlohmann::json point = toJson(record);
    point["point"] = toJson(identityOf(hit));
    point["pixelsAway"] = hit.pixelsAway;
    point["distance"] = hit.distance;
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == hit.cloud) {
            point["cloudName"] = cloud.name;
            addPlace(point, cloud, identityOf(hit));
        }
    return point;
}

std::variant<PickHit, std::string> Viewer::takeHit(const char* name) {
    const std::string nothing = jsonText({{"pending", false}, {name, nullptr}});
    if (!renderer_ || !renderer_->pickPending())
        return nothing;
    auto answer = renderer_->takePick();
    if (!answer.ok())
        return pickError(answer.error());
    if (!*answer)
        return jsonText({{"pending", true}});
    if (!(*answer)->hit)
        return nothing;
    return *(*answer)->hit;
}

std::string Viewer::takePickJson() {
    if (!picked_) {
        auto answer = takeHit("point");
        if (auto* json = std::get_if<std::string>(&answer))
            return *json;
        picked_ = std::get<PickHit>(answer);
        session_->takePointAnswers(); // of questions that nobody waits for any more
        if (Status asked = session_->askPoint(identityOf(*picked_)); !asked.ok()) {
            picked_.reset();
            return pickError(asked.error());
        }
    }
    for (const PointAnswer& answer : session_->takePointAnswers())
        if (answer.point == identityOf(*picked_)) {
            PickHit hit = *std::exchange(picked_, std::nullopt);
            if (!answer.record.ok())
                return pickError(answer.record.error());
            return jsonText({{"pending", false}, {"point", pickedJson(hit, *answer.record)}});
        }
    return jsonText({{"pending", true}});
}

std::string Viewer::takePlaceJson() {
    auto answer = takeHit("place");
    if (auto* json = std::get_if<std::string>(&answer))
        return *json;
    const PickHit& hit = std::get<PickHit>(answer);
    for (const CloudState& cloud : session_->clouds())
        if (cloud.id == hit.cloud && cloud.metadata) {
            Vec3d place = positionRecord(*cloud.metadata, *hit.node, hit.point).position;
            return jsonText({{"pending", false}, {"place", {place.x, place.y, place.z}}});
        }
    return jsonText({{"pending", false}, {"place", nullptr}});
}

} // namespace stipple::web
