// What picture a request asks for.
#pragma once

#include "client/headless/picture.hpp"
#include "server/api/endpoint.hpp"
#include "server/api/validity.hpp"
#include "server/http/negotiation.hpp"

#include <array>
#include <string>

namespace stipple::server {

inline constexpr std::uint64_t maxImagePixels = 8ull << 20;
inline constexpr double maxImageSide = 8192;
inline constexpr std::uint64_t maxImagePoints = 5'000'000;

inline constexpr std::array imageFormats{Format{"png", "image/png", "png"},
                                         Format{"webp", "image/webp", "webp"}};
inline constexpr auto imageFormatNames = namesOf(imageFormats);

namespace image_parameters {
// The names are those of client/core/json.hpp.
inline constexpr std::array<std::string_view, 3> views{"iso", "top", "front"};
inline constexpr std::array<std::string_view, 2> projections{"perspective", "orthographic"};
inline constexpr std::array<std::string_view, 9> modes{
    "rgb",           "intensity", "elevation", "classification", "returnNumber", "numberOfReturns",
    "pointSourceId", "gpsTime",   "level"};
inline constexpr std::array<std::string_view, 6> gradients{"viridis",  "turbo", "inferno",
                                                           "spectral", "grey",  "terrain"};
inline constexpr std::array<std::string_view, 2> shapes{"circle", "square"};
inline constexpr std::array<std::string_view, 2> switches{"on", "off"};
inline constexpr double farthest = 1e150; // squares stay finite

inline constexpr Parameter view{.name = "view",
                                .description =
                                    "A camera that shows the whole cloud, if no other camera is given.",
                                .kind = ParameterKind::choice,
                                .choices = views,
                                .example = "top",
                                .usual = "iso"};
inline constexpr Parameter eye{
    .name = "eye",
    .description = "Where the camera is, in the cloud's coordinates. With target in place of view.",
    .kind = ParameterKind::numbers,
    .form = "x,y,z",
    .example = "0,0,1000",
    .needs = "target=10,20,0"};
inline constexpr Parameter target{.name = "target",
                                  .description = "What the camera looks at.",
                                  .kind = ParameterKind::numbers,
                                  .form = "x,y,z",
                                  .example = "10,20,0",
                                  .needs = "eye=0,0,1000"};
inline constexpr Parameter up{.name = "up",
                              .description = "The direction that is up in the picture.",
                              .kind = ParameterKind::numbers,
                              .form = "x,y,z",
                              .example = "0,1,0",
                              .usual = "0,0,1",
                              .needs = "eye=0,100,1000&target=10,20,0"};
inline constexpr Parameter projection{.name = "projection",
                                      .description = "Perspective, or parallel.",
                                      .kind = ParameterKind::choice,
                                      .choices = projections,
                                      .example = "orthographic",
                                      .usual = "perspective"};
inline constexpr Parameter fov{
    .name = "fov",
    .description = "Field of view from top to bottom in degrees, of a perspective camera with eye.",
    .kind = ParameterKind::number,
    .least = 0.001,
    .most = 179,
    .example = "45",
    .usual = "60",
    .needs = "eye=0,100,1000&target=10,20,0"};
inline constexpr Parameter orthoHeight{
    .name = "orthoHeight",
    .description = "Height of the view in the cloud's units, of an orthographic camera with eye.",
    .kind = ParameterKind::number,
    .least = 1e-150,
    .most = farthest,
    .example = "500",
    .needs = "projection=orthographic&eye=0,100,1000&target=10,20,0"};
inline constexpr Parameter width{.name = "width",
                                 .description = "Pixels. Width times height is at most 8388608.",
                                 .kind = ParameterKind::count,
                                 .least = 1,
                                 .most = maxImageSide,
                                 .example = "64",
                                 .usual = "1280"};
inline constexpr Parameter height{.name = "height",
                                  .description = "Pixels.",
                                  .kind = ParameterKind::count,
                                  .least = 1,
                                  .most = maxImageSide,
                                  .example = "48",
                                  .usual = "720"};
inline constexpr Parameter mode{.name = "mode",
                                .description = "What colours points.",
                                .kind = ParameterKind::choice,
                                .choices = modes,
                                .example = "elevation",
                                .usual = "rgb"};
inline constexpr Parameter gradient{.name = "gradient",
                                    .description = "Of all modes but rgb and classification.",
                                    .kind = ParameterKind::choice,
                                    .choices = gradients,
                                    .example = "turbo",
                                    .usual = "viridis"};
inline constexpr Parameter pointSize{.name = "pointSize",
                                     .description = "Diameter of points in pixels.",
                                     .kind = ParameterKind::number,
                                     .least = 0.01,
                                     .most = 64,
                                     .example = "3",
                                     .usual = "2"};
inline constexpr Parameter pointShape{.name = "pointShape",
                                      .description = "The shape of points.",
                                      .kind = ParameterKind::choice,
                                      .choices = shapes,
                                      .example = "square",
                                      .usual = "circle"};
inline constexpr Parameter edl{.name = "edl",
                               .description = "Eye-dome lighting.",
                               .kind = ParameterKind::choice,
                               .choices = switches,
                               .example = "off",
                               .usual = "on"};
inline constexpr Parameter background{.name = "background",
                                      .description = "Six hexadecimal digits, red first.",
                                      .example = "ffffff",
                                      .usual = "181a1e",
                                      .pattern = "^[0-9A-Fa-f]{6}$"};
inline constexpr Parameter style{
    .name = "style",
    .description = "How points look, as JSON with the fields of `stipple render --style`: colours by any "
                   "attribute, mixtures, filters, hidden classes, clip boxes. Parameters of their own go "
                   "before it.",
    .example = R"({"colourMode":"elevation","filters":[{"attribute":"Intensity","min":1}]})"};
inline constexpr double mostPixels = 64; // of a point
inline constexpr Parameter budget{.name = "budget",
                                  .description = "Points drawn at most.",
                                  .kind = ParameterKind::count,
                                  .least = 1,
                                  .most = static_cast<double>(maxImagePoints),
                                  .example = "10000",
                                  .usual = "2000000"};
inline constexpr Parameter format{.name = "format",
                                  .description = "The format of the answer; goes before the field Accept.",
                                  .kind = ParameterKind::choice,
                                  .choices = imageFormatNames,
                                  .example = "png"};
} // namespace image_parameters

inline constexpr std::array imageParameters{image_parameters::view,
                                            image_parameters::eye,
                                            image_parameters::target,
                                            image_parameters::up,
                                            image_parameters::projection,
                                            image_parameters::fov,
                                            image_parameters::orthoHeight,
                                            image_parameters::width,
                                            image_parameters::height,
                                            image_parameters::mode,
                                            image_parameters::gradient,
                                            image_parameters::pointSize,
                                            image_parameters::pointShape,
                                            image_parameters::edl,
                                            image_parameters::background,
                                            image_parameters::style,
                                            image_parameters::budget,
                                            image_parameters::format,
                                            versionParameter};

// Errors as those of Query, which name the parameter.
Result<headless::PictureRequest> imageRequestOf(const Query& query);
// One form for all ways of asking for the same picture.
std::string canonicalText(const headless::PictureRequest& request);

} // namespace stipple::server
