#include "client/survey/picked_points.hpp"

#include "client/survey/uncertainty.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace stipple::survey {

namespace {

using nlohmann::json;

constexpr double maxSteps = 9007199254740992.0; // 2^53

Error wrong(Phrase what) {
    return Error{ErrorCode::invalidArgument, std::move(what), "measurement", ""};
}

Result<Vec3d> vectorFrom(const json& object, const char* name, std::size_t point) {
    auto at = object.find(name);
    if (at == object.end() || !at->is_array() || at->size() != 3 ||
        !std::all_of(at->begin(), at->end(), [](const json& number) {
            return number.is_number() && std::isfinite(number.get<double>());
        }))
        return wrong(say("points[", point, "].", name, " must be three numbers [x, y, z]"));
    return Vec3d{(*at)[0].get<double>(), (*at)[1].get<double>(), (*at)[2].get<double>()};
}

Result<GridPoint> gridPointFrom(const json& object, std::size_t index) {
    STIPPLE_TRY(steps, vectorFrom(object, "integers", index));
    STIPPLE_TRY(scale, vectorFrom(object, "scale", index));
    STIPPLE_TRY(offset, vectorFrom(object, "offset", index));
    GridPoint point{{}, {scale, offset}};
    for (int axis = 0; axis < 3; ++axis) {
        if (steps[axis] != std::floor(steps[axis]) || std::abs(steps[axis]) > maxSteps)
            return wrong(say("points[", index, "].integers must be whole numbers of at most 2^53"));
        if (!(scale[axis] > 0))
            return wrong(say("points[", index, "].scale must be above 0"));
        point.steps[axis] = static_cast<std::int64_t>(steps[axis]);
    }
    return point;
}

} // namespace

Result<PickedPoints> pickedPointsFrom(const json& request) {
    auto list = request.find("points");
    if (list == request.end() || !list->is_array() || list->empty() || list->size() > maxPickedPoints)
        return wrong(say("points must be a list of 1 to ", maxPickedPoints, " points"));
    PickedPoints picked;
    for (const json& item : *list) {
        std::size_t index = picked.points.size();
        if (!item.is_object())
            return wrong(say("points[", index, "] must be an object"));
        STIPPLE_TRY(point, gridPointFrom(item, index));
        auto spacing = item.find("spacing");
        if (spacing != item.end() && !(spacing->is_number() && spacing->get<double>() >= 0))
            return wrong(say("points[", index, "].spacing must be a number from 0 on"));
        picked.deviations.push_back(spacing == item.end() ? 0 : deviationOfSpacing(spacing->get<double>()));
        picked.points.push_back(point);
    }
    return picked;
}

} // namespace stipple::survey
