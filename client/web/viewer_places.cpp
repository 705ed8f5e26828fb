// Where places are in the viewer's picture, and what is measured from them.
#include "client/web/viewer.hpp"

#include "client/core/camera.hpp"
#include "client/core/json.hpp"
#include "client/core/screen_polygon.hpp"
#include "client/survey/measure_json.hpp"
#include "shared/select/region_json.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace stipple::web {

std::string Viewer::measureJson(std::string_view request) {
    Result<nlohmann::json> parsed = parseJson(request, "measurement");
    Result<nlohmann::json> answer = parsed.ok() ? survey::measureJson(*parsed) : parsed;
    if (!answer.ok())
        return jsonText({{"error", answer.error().said()}});
    return jsonText({{"answer", *answer}});
}

std::string Viewer::projectJson(std::string_view positions) const {
    Result<nlohmann::json> parsed = parseJson(positions, "positions");
    nlohmann::json places = nlohmann::json::array();
    if (!parsed.ok() || !parsed->is_array() || drawn_.width == 0)
        return jsonText(places);
    auto isNumber = [](const nlohmann::json& value) { return value.is_number(); };
    for (const nlohmann::json& position : *parsed) {
        if (!position.is_array() || position.size() != 3 ||
            !std::all_of(position.begin(), position.end(), isNumber)) {
            places.push_back(nullptr);
            continue;
        }
        Vec3d world{position[0].get<double>(), position[1].get<double>(), position[2].get<double>()};
        Vec3d pixel = projectToPixels(drawn_.view, drawn_.width, drawn_.height, world);
        bool isBehind = drawn_.view.projection == Projection::perspective && !(pixel.z > 0);
        places.push_back(isBehind ? nlohmann::json(nullptr) : nlohmann::json{pixel.x, pixel.y, pixel.z});
    }
    return jsonText(places);
}

std::string Viewer::screenPolygonJson(std::string_view corners) const {
    Result<nlohmann::json> parsed = parseJson(corners, "corners");
    std::vector<Point2d> places;
    if (parsed.ok() && parsed->is_array())
        for (const nlohmann::json& corner : *parsed)
            if (corner.is_array() && corner.size() == 2 && corner[0].is_number() && corner[1].is_number())
                places.push_back({corner[0].get<double>(), corner[1].get<double>()});
    return jsonText(toJson(screenPolygon(drawn_.view, drawn_.width, drawn_.height, places)));
}

} // namespace stipple::web
