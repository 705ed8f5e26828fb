// Everything below /api/v1: from a request to its answer. Pure but for what clouds keep open; knows no
// socket. Thread: any.
#pragma once

#include "server/api/endpoint.hpp"
#include "server/http/target.hpp"

#include <span>

namespace stipple::server {

// Is it a path of the API?
bool isApiPath(const Target& target);

// Answers a GET or HEAD whose target isApiPath(). Whether the client may see the cloud is settled before.
Answer answerApi(const HttpRequest& request, const Target& target, const CloudCatalog& catalog,
                 std::int64_t nowSeconds);

std::span<const Endpoint> endpoints();

} // namespace stipple::server
