// What /api/v1/openapi.json says: every endpoint of the table, its parameters by their rows, its formats and
// statuses, and the addresses beside the API (files of clouds, health), as OpenAPI 3.1
// (https://spec.openapis.org/oas/v3.1.0). Pure. Members of our own:
//
//   x-needs     of a parameter: others that have to be given with it, as a query
//   x-example   of an operation: a query that any cloud answers
#pragma once

#include "server/api/endpoint.hpp"

#include <nlohmann/json_fwd.hpp>

namespace stipple::server {

nlohmann::ordered_json openApiDocument(std::span<const Endpoint> endpoints);

// A row as a parameter object.
nlohmann::ordered_json openApiParameter(const Parameter& parameter);
// The problem documents of a status as a response object, and 304.
nlohmann::ordered_json openApiProblem(int status);

// The paths beside the API: files of clouds, health, metrics. What answers them is elsewhere (server/site,
// server/net).
nlohmann::ordered_json otherPathsJson();

} // namespace stipple::server
