// Everything below /api/v1: from a request to its answer. Pure but for what clouds and caches keep; knows no
// socket. Thread: any.
#pragma once

#include "server/api/endpoint.hpp"
#include "server/http/target.hpp"

#include <memory>
#include <span>

namespace stipple::server {

// Is it a path of the API?
bool isApiPath(const Target& target);

struct ApiContext {
    const CloudCatalog& catalog;
    ApiResources& resources;
    const Visitor& visitor; // who asks
};

// Answers a GET or HEAD whose target isApiPath(). Whether the visitor may read the target's cloud is settled
// before.
Answer answerApi(const HttpRequest& request, const Target& target, const ApiContext& context,
                 std::int64_t nowSeconds);

std::span<const Endpoint> endpoints();

// /openapi.json: all of them, as an OpenAPI 3.1 document (openapi_document.hpp).
Answer answerOpenApi(const ApiCall& call);

} // namespace stipple::server
