#include "server/api/image_request.hpp"

#include "client/core/json.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

namespace parameters = image_parameters;
using nlohmann::json;

Status takeChoice(const Query& query, const Parameter& parameter, json& to, const char* field) {
    STIPPLE_TRY(place, choiceOf(query, parameter));
    if (place)
        to[field] = parameter.choices[*place];
    return {};
}

Status takeVector(const Query& query, const Parameter& parameter, json& to, const char* field) {
    STIPPLE_TRY(numbers, numbersOf(query, parameter));
    if (!numbers)
        return {};
    for (double number : *numbers)
        if (std::abs(number) > parameters::farthest)
            return parameterError(parameter.name, "it is out of range", "give smaller numbers");
    to[field] = *numbers;
    return {};
}

Status takeNumber(const Query& query, const Parameter& parameter, json& to, const char* field) {
    STIPPLE_TRY(number, numberOf(query, parameter));
    if (number)
        to[field] = *number;
    return {};
}

Status takeCamera(const Query& query, headless::PictureRequest& request) {
    json camera = json::object(), projection = json::object();
    STIPPLE_CHECK(takeVector(query, parameters::eye, camera, "position"));
    STIPPLE_CHECK(takeVector(query, parameters::target, camera, "target"));
    STIPPLE_CHECK(takeVector(query, parameters::up, camera, "up"));
    STIPPLE_CHECK(takeNumber(query, parameters::fov, camera, "fovYDegrees"));
    STIPPLE_CHECK(takeNumber(query, parameters::orthoHeight, camera, "orthoHeight"));
    STIPPLE_CHECK(takeChoice(query, parameters::projection, projection, "projection"));
    STIPPLE_TRY(view, choiceOf(query, parameters::view));
    bool isOrthographic = projection.value("projection", "") == "orthographic";
    request.projection = isOrthographic ? Projection::orthographic : Projection::perspective;
    if (camera.empty()) {
        request.view = parameters::views[view.value_or(0)];
        return {};
    }
    if (view)
        return parameterError(parameters::view.name, "it is given beside a camera", "give one of the two");
    for (auto [parameter, field] : {std::pair{parameters::eye, "position"}, {parameters::target, "target"}})
        if (!camera.contains(field))
            return parameterError(parameter.name, "a camera needs it", "give eye and target");
    if (camera["position"] == camera["target"])
        return parameterError(parameters::target.name, "it is where the eye is", "look at another place");
    if (isOrthographic != camera.contains("orthoHeight"))
        return parameterError(parameters::orthoHeight.name,
                              isOrthographic ? "an orthographic camera needs it"
                                             : "it is of orthographic cameras",
                              "give projection=orthographic and orthoHeight, or neither");
    if (isOrthographic && camera.contains("fovYDegrees"))
        return parameterError(parameters::fov.name, "an orthographic camera has none", "leave it out");
    if (!camera.contains("up"))
        camera["up"] = {0, 0, 1};
    if (!isOrthographic && !camera.contains("fovYDegrees"))
        camera["fovYDegrees"] = 60;
    request.view = jsonText(camera);
    return {};
}

Status takeSize(const Query& query, headless::PictureRequest& request) {
    STIPPLE_TRY(width, countOf(query, parameters::width));
    STIPPLE_TRY(height, countOf(query, parameters::height));
    request.width = static_cast<int>(width.value_or(1280));
    request.height = static_cast<int>(height.value_or(720));
    std::uint64_t pixels =
        static_cast<std::uint64_t>(request.width) * static_cast<std::uint64_t>(request.height);
    if (pixels > maxImagePixels)
        return parameterError(width ? parameters::width.name : parameters::height.name,
                              cat("the picture would have ", pixels, " pixels"),
                              cat("width times height is at most ", maxImagePixels));
    return {};
}

Result<json> backgroundOf(const std::string& text) {
    json colour = json::array();
    for (std::size_t at = 0; at < 6 && text.size() == 6; at += 2) {
        int value = 0;
        auto [end, error] = std::from_chars(text.data() + at, text.data() + at + 2, value, 16);
        if (error == std::errc() && end == text.data() + at + 2 && text[at] != '-')
            colour.push_back(value);
    }
    if (colour.size() != 3)
        return parameterError(parameters::background.name, cat(quotedValue(text), " is no colour"),
                              "give six hexadecimal digits, such as ffffff");
    return colour;
}

// What the parameter `style` says.
Result<Style> styleOf(const Query& query) {
    const std::string* text = query.find(parameters::style.name);
    if (!text)
        return Style();
    Result<Style> style = styleFromJson(*text);
    if (!style.ok())
        return parameterError(parameters::style.name, style.error().sentence(),
                              "give a style as for stipple render --style");
    // A larger one takes more work than a picture may.
    if (std::max(style->sizePixels, style->minSizePixels) > parameters::mostPixels ||
        style->maxSizePixels > parameters::mostPixels)
        return parameterError(parameters::style.name,
                              cat("points of more than ", parameters::mostPixels, " pixels are not drawn"),
                              "give smaller sizes");
    return style;
}

Status takeStyle(const Query& query, headless::PictureRequest& request) {
    json style = json::object(), edl = json::object();
    STIPPLE_CHECK(takeChoice(query, parameters::mode, style, "colourMode"));
    STIPPLE_CHECK(takeChoice(query, parameters::gradient, style, "gradient"));
    STIPPLE_CHECK(takeChoice(query, parameters::pointShape, style, "shape"));
    STIPPLE_CHECK(takeNumber(query, parameters::pointSize, style, "sizePixels"));
    STIPPLE_CHECK(takeChoice(query, parameters::edl, edl, "edl"));
    if (edl.contains("edl"))
        style["edl"]["enabled"] = edl["edl"] == "on";
    if (const std::string* text = query.find(parameters::background.name)) {
        STIPPLE_TRY(colour, backgroundOf(*text));
        style["background"] = colour;
    }
    STIPPLE_TRY(base, styleOf(query));
    STIPPLE_TRY(read, styleFromJson(style, base));
    request.style = read;
    return {};
}

} // namespace

Result<headless::PictureRequest> imageRequestOf(const Query& query) {
    headless::PictureRequest request;
    STIPPLE_CHECK(takeCamera(query, request));
    STIPPLE_CHECK(takeSize(query, request));
    STIPPLE_CHECK(takeStyle(query, request));
    STIPPLE_TRY(budget, countOf(query, parameters::budget));
    request.limits.pointBudget = budget.value_or(request.limits.pointBudget);
    return request;
}

std::string canonicalText(const headless::PictureRequest& request) {
    return cat(request.width, "x", request.height, " ",
               request.projection == Projection::orthographic ? "orthographic " : "perspective ",
               request.view, " ", jsonText(toJson(request.style)), " ", request.limits.pointBudget);
}

} // namespace stipple::server
