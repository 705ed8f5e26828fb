// Everything below /api/v1: from a request to its answer. Pure but for what clouds keep open; knows no
// socket. Thread: any.
#pragma once

#include "server/api/endpoint.hpp"
#include "server/http/target.hpp"

#include <span>

namespace stipple::server {

// Is it a path of the API?
bool isApiPath(const Target& target);

// Answers a GET or HEAD whose target isApiPath(). Whether the visitor may read the target's cloud is settled
// before.
Answer answerApi(const HttpRequest& request, const Target& target, const CloudCatalog& catalog,
                 const Visitor& visitor, std::int64_t nowSeconds);

std::span<const Endpoint> endpoints();

} // namespace stipple::server
