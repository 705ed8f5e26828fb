// Errors as RFC 9457 problem documents (application/problem+json):
//
//   {"type": "/api/v1/problems/unknown-parameter", "title": "Unknown parameter", "status": 400,
//    "detail": "there is no parameter \"strat\"", "instance": "/api/v1/clouds/town/nodes/0-0-0-0",
//    "parameter": "strat"}
//
// Type addresses can be opened and say what is meant. Paths of this machine and query strings (which may
// hold a token) are never quoted.
#pragma once

#include "server/http/message.hpp"
#include "shared/base/result.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

struct ProblemType {
    const char* name; // last segment of the type's address
    int status;
    const char* title;   // the same each time
    const char* meaning; // when it comes and what to do; for people
};

namespace problem_types {
extern const ProblemType unknownParameter, invalidParameter, missingParameter, noSuchCloud, noSuchNode,
    notAcceptable, versionGone, workTooLarge, cloudUnusable, cloudChanged, upstreamFailed, upstreamTimedOut,
    outOfTime, tooManyRequests;
}

// All of them: those above, and a general one for each status that is used.
std::span<const ProblemType> problemTypes();
std::string problemAddress(const ProblemType& type); // "/api/v1/problems/NAME"

struct Problem {
    ProblemType type;
    std::string detail;                      // what is wrong with this very request
    std::string parameter = {};              // that is at fault; empty: none
    std::vector<std::string> available = {}; // 406: the media types there are
};

// Never cached. `instance` is added by setProblemInstance.
HttpResponse problemResponse(const Problem& problem);
// Of the general type of that status.
HttpResponse problemResponse(int status, const std::string& detail);

// For an error met while opening what a path names: 404 where it is absent or no file, 503 where descriptors
// ran out, else 500.
HttpResponse problemResponse(const Error& error);
// For an error met while making an answer out of a cloud that was found: 400 for what the request asked for,
// 502 or 504 where an upstream failed, 503 where the cloud's file is damaged, changed or time ran out.
HttpResponse jobProblem(const Error& error);

// 400 for a parameter of the query (server/api/query.hpp): detail is the error's sentence, and the extension
// member "parameter" names it where error.where does.
HttpResponse parameterProblem(const Error& error);

// 405 with Allow (RFC 9110 §15.5.6), or 501 for methods nobody knows.
HttpResponse methodNotAllowed(std::string_view method, const std::string& allow);

// Names the path of the request's target in a problem document; leaves other responses as they are.
void setProblemInstance(HttpResponse& response, std::string_view target);

} // namespace stipple::server
