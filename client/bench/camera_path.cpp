#include "client/bench/camera_path.hpp"

#include "client/core/json.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

namespace stipple::bench {
namespace {

constexpr double degree = std::numbers::pi / 180;

// What paths are made from: a box that has a size in each direction.
struct Place {
    explicit Place(const BoxD& content) : min(content.min), size(content.max - content.min) {
        double longest = std::max({size.x, size.y, size.z});
        for (int axis = 0; axis < 3; ++axis)
            size[axis] = std::max(size[axis], longest > 0 ? longest * 1e-3 : 1.0);
        radius = length(size) / 2;
    }
    // A place in the box, by parts of its sides.
    Vec3d at(double x, double y, double z) const {
        return {min.x + x * size.x, min.y + y * size.y, min.z + z * size.z};
    }

    Vec3d min, size;
    double radius = 0;
};

// A unit vector from its angles over the horizon.
Vec3d direction(double azimuth, double elevation) {
    return {std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation),
            std::sin(elevation)};
}

Camera looking(Vec3d from, Vec3d at) {
    Camera camera;
    camera.position = from;
    camera.target = at;
    return camera;
}

double fraction(double value) {
    return value - std::floor(value);
}

// Frame `i` of `frames`; t is 0 at the first and 1 at the last.
struct Moment {
    int i = 0;
    int frames = 1;
    double t = 0;
};

Camera flyOver(const Place& place, const Moment& moment) {
    bool alongX = place.size.x >= place.size.y;
    double along = 0.8 * moment.t, longer = std::max(place.size.x, place.size.y);
    Vec3d from = alongX ? place.at(along, 0.5, 1) : place.at(0.5, along, 1);
    from.z += 0.15 * longer;
    return looking(from, from + direction(alongX ? 0 : 90 * degree, -35 * degree) * (0.3 * longer));
}

Camera walk(const Place& place, const Moment& moment) {
    Vec3d begin = place.at(0.3, 0.35, 0.3), end = place.at(0.6, 0.6, 0.3);
    Vec3d from = begin + (end - begin) * moment.t;
    return looking(from, from + (end - begin) * 0.2 - Vec3d{0, 0, 0.02 * length(end - begin)});
}

Camera orbitFrame(const Place& place, const Moment& moment) {
    Vec3d centre = place.at(0.5, 0.5, 0.5);
    double azimuth = 360 * degree * moment.i / moment.frames;
    return looking(centre + direction(azimuth, 30 * degree) * (1.6 * place.radius), centre);
}

// Places and angles by the R2 sequence (Roberts 2018) and the golden angle: evenly spread, without a pattern.
Camera jump(const Place& place, const Moment& moment) {
    constexpr std::array<double, 3> distances{1.8, 0.12, 0.45}; // of the radius
    double i = moment.i;
    Vec3d target =
        place.at(fraction(0.5 + i * 0.7548776662466927), fraction(0.5 + i * 0.5698402909980532), 0.4);
    double elevation = (25 + 45 * fraction(i * 0.6180339887498949)) * degree;
    double distance = distances[static_cast<std::size_t>(moment.i) % 3] * place.radius;
    return looking(target + direction(i * 2.399963229728653, elevation) * distance, target);
}

Camera dolly(const Place& place, const Moment& moment) {
    Vec3d centre = place.at(0.5, 0.5, 0.5);
    return looking(centre + direction(-120 * degree, 30 * degree) * (place.radius * std::pow(0.97, moment.i)),
                   centre);
}

Camera map(const Place& place, const Moment& moment) {
    Vec3d target = place.at(0.4, 0.6, 0.5);
    Camera camera = looking(target + Vec3d{0, 0, 2 * place.radius}, target);
    camera.projection = Projection::orthographic;
    camera.orthoHeight = std::max(place.size.x, place.size.y) * std::pow(0.7, moment.i);
    return camera;
}

struct NamedPath {
    std::string_view name;
    Camera (*frame)(const Place&, const Moment&);
};
constexpr std::array<NamedPath, 6> builtIn{NamedPath{"fly-over", flyOver},
                                           {"walk", walk},
                                           {"orbit", orbitFrame},
                                           {"jump", jump},
                                           {"dolly", dolly},
                                           {"map", map}};

Error pathError(const std::string& what) {
    return {ErrorCode::invalidArgument, what, "camera paths", ""};
}

Result<CameraPath> pathFromJson(const nlohmann::json& json) {
    if (!json.is_object() || !json.value("name", nlohmann::json()).is_string() ||
        !json.value("cameras", nlohmann::json()).is_array() || json.size() != 2)
        return pathError("each path is {\"name\": …, \"cameras\": […]}");
    CameraPath path{json["name"].get<std::string>(), {}};
    Camera camera;
    for (const nlohmann::json& item : json["cameras"]) {
        STIPPLE_TRY(next, cameraFromJson(item, camera));
        if (!isUsable(next))
            return pathError(cat("path '", path.name, "': camera ", path.cameras.size(), " can't be used"));
        camera = next;
        path.cameras.push_back(camera);
    }
    if (path.cameras.empty())
        return pathError(cat("path '", path.name, "' has no cameras"));
    return path;
}

} // namespace

std::vector<std::string_view> pathNames() {
    std::vector<std::string_view> names;
    for (const NamedPath& path : builtIn)
        names.push_back(path.name);
    return names;
}

Result<CameraPath> builtInPath(std::string_view name, const BoxD& content, int frames) {
    for (const NamedPath& path : builtIn) {
        if (path.name != name)
            continue;
        CameraPath made{std::string(name), {}};
        Place place(content);
        for (int i = 0; i < frames; ++i)
            made.cameras.push_back(
                path.frame(place, {i, frames, frames > 1 ? double(i) / (frames - 1) : 0.0}));
        return made;
    }
    std::string known;
    for (std::string_view text : pathNames())
        known += cat(known.empty() ? "" : ", ", text);
    return Error{ErrorCode::invalidArgument, cat("there is no path '", name, "'"), "--paths",
                 cat("choose of ", known)};
}

Result<std::vector<CameraPath>> pathsFromJson(const nlohmann::json& json) {
    if (!json.is_object() || json.size() != 1 || !json.value("paths", nlohmann::json()).is_array())
        return pathError("{\"paths\": […]} is expected");
    std::vector<CameraPath> paths;
    for (const nlohmann::json& item : json["paths"]) {
        STIPPLE_TRY(path, pathFromJson(item));
        paths.push_back(std::move(path));
    }
    return paths;
}

nlohmann::json toJson(const CameraPath& path) {
    nlohmann::json cameras = nlohmann::json::array();
    for (const Camera& camera : path.cameras)
        cameras.push_back(stipple::toJson(camera));
    return {{"name", path.name}, {"cameras", std::move(cameras)}};
}

} // namespace stipple::bench
