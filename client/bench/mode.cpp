#include "client/bench/mode.hpp"

#include "client/core/json.hpp"
#include "shared/base/json_fields.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>

namespace stipple::bench {
namespace {

using nlohmann::json;

// The table. JSON, so that a mode says what differs from the defaults and nothing else.
constexpr const char* table = R"json([
{"name": "default", "about": "the page's style: circles of 2 pixels, eye-dome lighting of 8 neighbours", "sweep": true},
{"name": "pixels", "about": "single pixels, no lighting", "sweep": true, "group": "shapes and splats", "against": "circles",
 "style": {"sizePixels": 1, "shape": "square", "edl": {"enabled": false}}},
{"name": "weighted", "about": "default, the picture's middle and what is near first (weights down to 0.5)", "sweep": true,
 "group": "detail", "against": "default", "limits": {"leastCentreWeight": 0.5, "leastDepthWeight": 0.5}},
{"name": "continuous", "about": "default, with continuous detail", "sweep": true, "group": "detail", "against": "default",
 "style": {"detail": {"mode": "continuous"}}},
{"name": "continuous-spacing", "about": "continuous detail, circles of two target spacings, no lighting", "sweep": true,
 "group": "detail", "against": "adaptive",
 "style": {"detail": {"mode": "continuous"}, "sizeMode": "spacing", "edl": {"enabled": false}}},
{"name": "circles", "about": "circles of 2 pixels, no lighting", "sweep": true, "group": "shapes and splats",
 "style": {"edl": {"enabled": false}}},
{"name": "squares-3", "about": "squares of 3 pixels, no lighting", "group": "shapes and splats", "against": "circles",
 "style": {"sizePixels": 3, "shape": "square", "edl": {"enabled": false}}},
{"name": "world", "about": "circles as wide as the points are apart, no lighting", "worldSizeSpacings": 1.5,
 "group": "shapes and splats", "against": "circles",
 "style": {"sizeMode": "world", "edl": {"enabled": false}}},
{"name": "adaptive", "about": "circles of two spacings of the finest node where they lie, no lighting", "sweep": true,
 "group": "shapes and splats", "against": "circles",
 "style": {"sizeMode": "adaptive", "edl": {"enabled": false}}},
{"name": "paraboloid", "about": "paraboloids of 5 pixels, no lighting", "group": "shapes and splats", "against": "circles",
 "style": {"sizePixels": 5, "shape": "paraboloid", "edl": {"enabled": false}}},
{"name": "splats", "about": "high-quality splats of 3 pixels, no lighting", "sweep": true,
 "group": "shapes and splats", "against": "circles",
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "splats-world", "about": "high-quality splats as wide as the points are apart, no lighting", "sweep": true, "worldSizeSpacings": 1.5,
 "group": "shapes and splats", "against": "world",
 "style": {"sizeMode": "world", "minSizePixels": 2, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "splats-adaptive", "about": "high-quality splats of two spacings of the finest node, no lighting", "sweep": true,
 "group": "shapes and splats", "against": "adaptive",
 "style": {"sizeMode": "adaptive", "minSizePixels": 2, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "splats-continuous", "about": "continuous detail, high-quality splats of two target spacings, no lighting", "sweep": true,
 "group": "shapes and splats", "against": "continuous-spacing",
 "style": {"detail": {"mode": "continuous"}, "sizeMode": "spacing", "minSizePixels": 2, "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "delayed-expansion", "about": "default, each pixel's nearest centre first", "sweep": true,
 "group": "delayed expansion", "against": "default", "style": {"delayedExpansion": "on"}},
{"name": "splats-delayed", "about": "splats, each pixel's nearest centre first", "sweep": true,
 "group": "delayed expansion", "against": "splats",
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}, "delayedExpansion": "on"}},
{"name": "discs-circles", "about": "circles of 5 pixels, no lighting: what discs are without normals", "group": "shapes and splats",
 "style": {"sizePixels": 5, "edl": {"enabled": false}}},
{"name": "discs", "about": "discs of 5 pixels along the points' normals, no lighting", "group": "shapes and splats", "against": "discs-circles",
 "style": {"sizePixels": 5, "shape": "disc", "edl": {"enabled": false}}},
{"name": "discs-adaptive", "about": "discs of two spacings of the finest node where they lie, no lighting", "sweep": true,
 "group": "shapes and splats", "against": "adaptive",
 "style": {"sizeMode": "adaptive", "shape": "disc", "edl": {"enabled": false}}},
{"name": "discs-splats", "about": "high-quality splats as discs of 5 pixels, no lighting", "group": "shapes and splats", "against": "discs",
 "style": {"sizePixels": 5, "shape": "disc", "splats": {"enabled": true}, "edl": {"enabled": false}}},
{"name": "edl-4", "about": "circles of 2 pixels, lighting of 4 neighbours", "style": {"edl": {"neighbours": 4}}},
{"name": "intensity", "about": "default, by intensity", "style": {"colourMode": "intensity"}},
{"name": "elevation", "about": "default, by elevation", "style": {"colourMode": "elevation"}},
{"name": "classification", "about": "default, by classification", "style": {"colourMode": "classification"}},
{"name": "gps-time", "about": "default, by GPS time", "style": {"colourMode": "gpsTime"}},
{"name": "mix", "about": "default, half colour, half intensity",
 "style": {"colourMode": "mix", "mix": [{"colourMode": "rgb"}, {"colourMode": "intensity"}]}},
{"name": "filter", "about": "default, without points of later returns",
 "style": {"filters": [{"attribute": "Return Number", "max": 1}]}},
{"name": "clip", "about": "default, without what lies outside a turned box of half the cloud's sides", "sweep": true, "clipPart": 0.5},
{"name": "all-nodes", "about": "default, without the limit on the size of nodes", "sweep": true,
 "group": "skips", "against": "default", "limits": {"minNodePixels": 0}},
{"name": "unseen-too", "about": "default, nodes outside the view drawn too", "sweep": true,
 "group": "skips", "against": "default", "without": ["unseen"]},
{"name": "unused-too", "about": "default, attributes that nobody looks at fetched too",
 "group": "skips", "against": "default", "without": ["unused"]},
{"name": "lit-in-vain", "about": "circles, with the pass of a lighting that changes nothing", "sweep": true,
 "group": "skips", "against": "circles", "style": {"edl": {"strength": 1e-12}}},
{"name": "clipped-too", "about": "clip, nodes that are clipped away drawn too", "sweep": true, "clipPart": 0.5,
 "group": "skips", "against": "clip", "without": ["clipped", "hidden"]},
{"name": "hidden-too", "about": "filter, nodes of which it hides every point drawn too",
 "group": "skips", "against": "filter", "without": ["hidden"],
 "style": {"filters": [{"attribute": "Return Number", "max": 1}]}},
{"name": "too-fine-too", "about": "continuous, whole nodes instead of the prefixes that can show", "sweep": true,
 "group": "skips", "against": "continuous", "without": ["tooFine"],
 "style": {"detail": {"mode": "continuous"}}},
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
 "group": "delayed expansion", "against": "gles-default", "style": {"delayedExpansion": "on"}},
{"name": "gles-splats-delayed", "about": "splats-delayed, with OpenGL ES", "backend": "gles",
 "group": "delayed expansion", "against": "gles-splats",
 "style": {"sizePixels": 3, "splats": {"enabled": true}, "edl": {"enabled": false}, "delayedExpansion": "on"}},
{"name": "gles-paraboloid", "about": "paraboloid, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 5, "shape": "paraboloid", "edl": {"enabled": false}}},
{"name": "gles-discs", "about": "discs, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 5, "shape": "disc", "edl": {"enabled": false}}},
{"name": "gles-pixels", "about": "pixels, with OpenGL ES", "backend": "gles",
 "style": {"sizePixels": 1, "shape": "square", "edl": {"enabled": false}}}
])json";

constexpr json_fields::Names<headless::Backend, 2> backends{{
    {"software", headless::Backend::software},
    {"gles", headless::Backend::gles},
}};

constexpr std::pair<const char*, bool Skips::*> skipNames[] = {{"unseen", &Skips::unseen},
                                                               {"clipped", &Skips::clipped},
                                                               {"hidden", &Skips::hidden},
                                                               {"tooFine", &Skips::tooFine},
                                                               {"unused", &Skips::unused}};

// Turns off what `names` lists.
Status readSkips(const json& names, const std::string& mode, Skips& skips) {
    auto refused = [&](const std::string& what) {
        return Error{ErrorCode::invalidArgument, cat("mode '", mode, "': without ", what), "modes",
                     "a list of unseen, clipped, hidden, tooFine, unused"};
    };
    if (!names.is_array())
        return refused("is no list");
    for (const json& name : names) {
        std::string word = name.is_string() ? name.get<std::string>() : "";
        auto named = [&](const auto& known) { return word == known.first; };
        auto found = std::find_if(std::begin(skipNames), std::end(skipNames), named);
        if (found == std::end(skipNames))
            return refused(cat("has ", name.dump(), ", which is no skip"));
        skips.*found->second = false;
    }
    return {};
}

json toJson(const Skips& skips) {
    json without = json::array();
    for (const auto& [name, member] : skipNames)
        if (!(skips.*member))
            without.push_back(name);
    return without;
}

// Takes a word out of `rest`, if it is there.
void takeWord(json& rest, const char* name, std::string& word) {
    if (rest.contains(name) && rest[name].is_string()) {
        word = rest[name].get<std::string>();
        rest.erase(name);
    }
}

Result<Mode> modeFromJson(const json& value) {
    if (!value.is_object() || !value.value("name", json()).is_string())
        return Error{ErrorCode::invalidArgument, "each mode is an object with a name", "modes", ""};
    Mode mode;
    mode.name = value["name"].get<std::string>();
    json rest = value;
    rest.erase("name");
    takeWord(rest, "about", mode.about);
    takeWord(rest, "group", mode.group);
    takeWord(rest, "against", mode.against);
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
    if (rest.contains("without")) {
        STIPPLE_CHECK(readSkips(rest["without"], mode.name, mode.limits.skips));
        rest.erase("without");
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
            {"clipPart", mode.clipPart},
            {"group", mode.group},
            {"against", mode.against},
            {"without", toJson(mode.limits.skips)}};
}

} // namespace stipple::bench
