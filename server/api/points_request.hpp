// Which points a request asks for.
#pragma once

#include "server/api/endpoint.hpp"
#include "shared/base/result.hpp"
#include "shared/select/point_filter.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stipple::server {

struct PointsRequest {
    PointFilter filter;
    std::uint64_t limit = 0;     // 0: all
    std::vector<int> attributes; // indices into metadata.schema.attributes, in the order asked for
};

// What the query says of the parameters that points are chosen by (points_parameters.hpp); the profile's line
// among them. All of it has a meaning for the cloud: CloudFilter::make takes it. Errors name the parameter:
// invalidArgument, and notFound for one that has to be there.
Result<PointsRequest> pointsRequestOf(const ApiCall& call);

// One form for all queries that give the same values to these parameters, in whatever order: "limit=2:10\n…".
std::string canonicalQuery(const Query& query, std::span<const Parameter> parameters);

// The problem document for such an error.
HttpResponse requestProblem(const Error& error);
Error missingParameter(const Parameter& parameter);

} // namespace stipple::server
