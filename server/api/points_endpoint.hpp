// Points of a cloud as a file, chosen by the query (points_parameters.hpp):
//
//   /clouds/{id}/points     by region, class, values, level of detail
//   /clouds/{id}/profile    along a line; with two attributes more, Station and Offset
//   (corridor_attributes.hpp)
//
// LAS, CSV and PLY are sent while they are made, LAZ (whose beginning is written last) once it is complete,
// from a file without a name. The order is that of the cloud's file: node by node, coarse ones first.
// Stipple-Point-Count says how many points there are where that is known before the first byte: always but
// for CSV of a part of a cloud.
//
// What would be more than ApiLimits allow is refused before it begins, and cut where it shows only later.
#pragma once

#include "server/api/endpoint.hpp"

namespace stipple::server {

Answer answerPoints(const ApiCall& call);
Answer answerProfile(const ApiCall& call);

} // namespace stipple::server
