#include "client/bench/mode.hpp"

#include "client/core/json.hpp"
#include "client/core/json_fields.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <cstdlib>

namespace stipple::bench {
namespace {

using nlohmann::json;

// The table. JSON, so that a mode says what differs from the defaults and nothing else.
constexpr const char* table = R"json([
{"name": "default", "about": "the page's style: circles of 2 pixels, eye-dome lighting of 8 neighbours", "sweep": true},
{"name": "pixels", "about": "single pixels, no lighting", "sweep": true,
 "style": {"sizePixels": 1, "shape": "square", "edl": {"enabled": false}}},
{"name": "all-nodes", "about": "default, without the limit on the size of nodes", "sweep": true,
 "limits": {"minNodePixels": 0}},
{"name": "weighted", "about": "default, the picture's middle and what is near first (weights down to 0.5)", "sweep": true,
 "limits": {"leastCentreWeight": 0.5, "leastDepthWeight": 0.5}},
{"name": "continuous", "about": "default, with continuous detail", "sweep": true,
 "style": {"detail": {"mode": "continuous"}}},
{"name": "continuous-spacing", "about": "continuous detail, circles as wide as the target spacing, no lighting", "sweep": true,
 "style": {"detail": {"mode": "continuous"}, "sizeMode": "spacing", "edl": {"enabled": false}}},
{"name": "circles", "about": "circles of 2 pixels, no lighting", "style": {"edl": {"enabled": false}}},
{"name": "squares-3", "about": "squares of 3 pixels, no lighting",
 "style": {"sizePixels": 3, "shape": "square", "edl": {"enabled": false}}},
{"name": "world", "about": "circles as wide as the points are apart, no lighting", "worldSizeSpacings": 1.5,
 "style": {"sizeMode": "world", "edl": {"enabled": false}}},
{"name": "adaptive", "about": "circles as wide as the spacing of the finest node where they lie, no lighting", "sweep": true,
 "style": {"sizeMode": "adaptive", "edl": {"enabled": false}}},
{"name": "splats", "about": "high-quality splats of 3 pixels, no lighting", "sweep": true,
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "splats-adaptive", "about": "high-quality splats as wide as the spacing of the finest node, no lighting", "sweep": true,
 "style": {"sizeMode": "adaptive", "minSizePixels": 2, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "delayed-expansion", "about": "default, each pixel's nearest centre first", "sweep": true,
 "style": {"delayedExpansion": "on"}},
{"name": "splats-delayed", "about": "splats, each pixel's nearest centre first", "sweep": true,
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}, "delayedExpansion": "on"}},
{"name": "paraboloid", "about": "paraboloids of 5 pixels, no lighting",
 "style": {"sizePixels": 5, "shape": "paraboloid", "edl": {"enabled": false}}},
{"name": "edl-4", "about": "circles of 2 pixels, lighting of 4 neighbours", "style": {"edl": {"neighbours": 4}}},
{"name": "intensity", "about": "default, by intensity", "style": {"colourMode": "intensity"}},
{"name": "elevation", "about": "default, by elevation", "style": {"colourMode": "elevation"}},
{"name": "classification", "about": "default, by classification", "style": {"colourMode": "classification"}},
{"name": "gps-time", "about": "default, by GPS time", "style": {"colourMode": "gpsTime"}},
{"name": "mix", "about": "default, half colour, half intensity",
 "style": {"colourMode": "mix", "mix": [{"colourMode": "rgb"}, {"colourMode": "intensity"}]}},
{"name": "filter", "about": "default, without points of later returns", "style": {"filters": [{"attribute": "Return Number", "max": 1}]}},
{"name": "clip", "about": "default, without what lies outside a turned box of half the cloud's sides", "clipPart": 0.5},
{"name": "gles-clip", "about": "clip, with OpenGL ES", "clipPart": 0.5, "backend": "gles"},
{"name": "gles-classification", "about": "default, by classification, with OpenGL ES", "backend": "gles",
 "style": {"colourMode": "classification"}},
{"name": "gles-default", "about": "default, with OpenGL ES", "backend": "gles"},
{"name": "gles-continuous", "about": "default, with continuous detail and OpenGL ES", "backend": "gles",
 "style": {"detail": {"mode": "continuous"}}},
{"name": "gles-adaptive", "about": "adaptive, with OpenGL ES", "backend": "gles",
 "style": {"sizeMode": "adaptive", "edl": {"enabled": false}}},
{"name": "gles-splats", "about": "splats, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "gles-delayed-expansion", "about": "delayed-expansion, with OpenGL ES", "backend": "gles",
 "style": {"delayedExpansion": "on"}},
{"name": "gles-paraboloid", "about": "paraboloid, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 5, "shape": "paraboloid", "edl": {"enabled": false}}},
{"name": "gles-pixels", "about": "pixels, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 1, "shape": "square", "edl": {"enabled": false}}}
])json";

constexpr json_fields::Names<headless::Backend, 2> backends{{
    {"software", headless::Backend::software},
    {"gles", headless::Backend::gles},
}};

Result<Mode> modeFromJson(const json& value) {
    if (!value.is_object() || !value.value("name", json()).is_string())
        return Error{ErrorCode::invalidArgument, "each mode is an object with a name", "modes", ""};
    Mode mode;
    mode.name = value["name"].get<std::string>();
    json rest = value;
    rest.erase("name");
    if (rest.contains("about") && rest["about"].is_string()) {
        mode.about = rest["about"].get<std::string>();
        rest.erase("about");
    }
    if (rest.contains("style")) {
        STIPPLE_TRY(style, styleFromJson(rest["style"]));
        mode.style = style;
        rest.erase("style");
    }
    if (rest.contains("limits")) {
        STIPPLE_TRY(limits, limitsFromJson(rest["limits"]));
        mode.limits = limits;
        rest.erase("limits");
    }
    json_fields::FieldReader fields(rest, cat("mode '", mode.name, "'"));
    fields.choice("backend", mode.backend, backends);
    fields.flag("sweep", mode.sweep);
    fields.number("worldSizeSpacings", mode.worldSizeSpacings, 0, 1e6);
    fields.number("clipPart", mode.clipPart, 0, 1);
    STIPPLE_CHECK(fields.finish());
    return mode;
}

} // namespace

const std::vector<Mode>& builtInModes() {
    static const std::vector<Mode> modes = [] {
        auto read = modesFromJson(json::parse(table));
        if (!read.ok())
            std::abort(); // the table itself is wrong; tests read it
        return std::move(*read);
    }();
    return modes;
}

Result<std::vector<Mode>> modesFromJson(const json& value) {
    if (!value.is_array())
        return Error{ErrorCode::invalidArgument, "a list of modes is expected", "modes", ""};
    std::vector<Mode> modes;
    for (const json& item : value) {
        STIPPLE_TRY(mode, modeFromJson(item));
        modes.push_back(std::move(mode));
    }
    return modes;
}

const char* backendName(headless::Backend backend) {
    return json_fields::nameOf(backends, backend);
}

json toJson(const Mode& mode) {
    return {{"name", mode.name},
            {"about", mode.about},
            {"style", stipple::toJson(mode.style)},
            {"limits", stipple::toJson(mode.limits)},
            {"backend", backendName(mode.backend)},
            {"sweep", mode.sweep},
            {"worldSizeSpacings", mode.worldSizeSpacings},
            {"clipPart", mode.clipPart}};
}

} // namespace stipple::bench
