// /clouds/{id}/nodes/{key}: the points of one node, or a prefix of them (strata), with some of their
// attributes. As stored, these are the very bytes of the cloud's file (docs/FORMAT.md, "Nodes"), whose sizes
// the hierarchy has; other formats hold decoded points in progressive order.
#pragma once

#include "server/api/endpoint.hpp"
#include "server/api/node_request.hpp"
#include "server/api/point_formats.hpp"
#include "server/api/validity.hpp"

#include <array>

namespace stipple::server {

inline constexpr Format storedFormat{"stored", "application/octet-stream", "bin"};
inline constexpr std::array nodeFormats{storedFormat, jsonFormat, csvFormat, lasFormat, lazFormat, plyFormat};
inline constexpr auto nodeFormatNames = namesOf(nodeFormats);
inline constexpr Parameter nodeFormatParameter{
    .name = "format",
    .description = "The format of the answer; goes before the field Accept.",
    .kind = ParameterKind::choice,
    .choices = nodeFormatNames,
    .example = "json",
};
inline constexpr std::array nodeParameters{strataParameter, attributesParameter, nodeFormatParameter,
                                           versionParameter};

Answer answerNode(const ApiCall& call);

} // namespace stipple::server
