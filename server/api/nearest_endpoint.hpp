// /clouds/{id}/nearest: the points nearest to a place, or the first along a ray, exactly:
//
//   {"id", "version",
//    "points": [{"node": "2-1-0-0", "index": 17,          of a node's points, in their stored order
//                "grid": [x, y, z],                        exact integers
//                "position": [x, y, z],                    world units, the decimals that the integers mean
//                "distance": 1.5,                          from the place; of a ray, from the ray
//                "along": 40.25,                           of rays: from the origin
//                "attributes": {"Intensity": 143, …}}],    values as in CSV; null: no value
//    "read": {"nodes", "bytes", "points", "hierarchyChunks"}}
//
// Best first; equally good ones by node and index.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

Answer answerNearest(const ApiCall& call);

} // namespace stipple::server
