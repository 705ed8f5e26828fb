// /clouds/{id}/hierarchy/{key}: a node and those below it, as far as one chunk of the file describes them:
//
//   {"id", "version", "key": "0-0-0-0",
//    "attributeBlocks": [["Return Number", "Number of Returns"], ["GPS Time"]],   what attributeBytes is of
//    "nodes": [{"key": "1-0-1-0", "childMask": 5, "pointCount": 1000,
//               "bounds": {"min": [x, y, z], "max": […]},      its cube, world units
//               "spacing": 0.5,                                of its level, world units
//               "offset": 65536, "strataBytes": [4, 3, 2, 9],  in the cloud's file
//               "attributeBytes": [10, 20],
//               "childChunk": {"offset", "size"} or null}]}    where its children are, if not in this list
//
// Nodes are breadth first. Those below a node with a childChunk are /hierarchy/ITS-KEY.
#pragma once

#include "server/api/endpoint.hpp"
#include "server/api/validity.hpp"

#include <array>

namespace stipple::server {

inline constexpr std::array hierarchyParameters{versionParameter};

Answer answerHierarchy(const ApiCall& call);

} // namespace stipple::server
