// What an endpoint of the API is: a path, what may be asked of it, and a function from a request to its
// answer. One table of these (endpoints.cpp) routes requests and is what /api/v1/openapi.json says.
#pragma once

#include "server/access/visitor.hpp"
#include "server/api/api_resources.hpp"
#include "server/api/parameter.hpp"
#include "server/http/job.hpp"
#include "server/http/message.hpp"
#include "server/http/negotiation.hpp"
#include "server/site/cloud_catalog.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

// A GET or HEAD of an endpoint, by someone who may make it. All of it outlives the look-up, but only
// `resources` and `catalog` outlive a job: jobs copy what else they need (`cloud` above all, which keeps
// this version of the file open).
struct ApiCall {
    const HttpRequest& request;
    const Query& query;             // has no parameter but those of the endpoint
    std::vector<std::string> names; // what the path has for each {…} of the endpoint's, decoded
    // Of {id}, where the endpoint's path has one.
    std::string id;
    std::shared_ptr<const CloudVersion> cloud;
    std::int64_t nowSeconds = 0; // since 1970
    const Visitor& visitor;      // who asks; may read `cloud`
    const CloudCatalog& catalog;
    ApiResources& resources;
};

struct Endpoint {
    std::string_view path; // below /api/v1: "/clouds/{id}/nodes/{key}"
    Answer (*answer)(const ApiCall& call);
    std::string_view name;                      // for programs that make functions of it: "getNode"
    std::string_view summary;                   // what it answers, in a sentence
    std::span<const Parameter> parameters = {}; // of the query; others are refused
    std::span<const Format> formats = {};       // the first one where the request names none
    std::string_view schema = {};               // of JSON among them (openapi_schemas.hpp)
    std::string_view example = {};              // query that any cloud answers
    bool isWork = true;                         // may be made by a job: 429 where its client has too many
    bool hasRanges = false;                     // 206, 416

    bool isOfCloud() const { return path.starts_with("/clouds/{id}"); }
};

} // namespace stipple::server
