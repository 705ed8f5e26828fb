#include "server/http/problem.hpp"

#include "shared/base/text.hpp"
#include "shared/io/range_answer.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;
constexpr const char* problemMediaType = "application/problem+json";

// `replace`: a detail may quote bytes of the request that are no UTF-8.
std::string textOf(const Json& document) {
    return document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

// One for each status.
constexpr std::array general{
    ProblemType{"bad-request", 400, "Bad Request", "The request can't be read as one that is meant here."},
    ProblemType{"unauthorized", 401, "Unauthorized", "This needs a token, or another one."},
    ProblemType{"forbidden", 403, "Forbidden", "This token does not open this."},
    ProblemType{"not-found", 404, "Not Found", "There is nothing at this address."},
    ProblemType{"method-not-allowed", 405, "Method Not Allowed", "The field Allow has those that are."},
    ProblemType{"request-timeout", 408, "Request Timeout", "The request took too long to arrive."},
    ProblemType{"precondition-failed", 412, "Precondition Failed",
                "What is here is not the version that the request asks for; the field ETag has its tag."},
    ProblemType{"content-too-large", 413, "Content Too Large", "No endpoint takes a body."},
    ProblemType{"uri-too-long", 414, "URI Too Long", "Ask for less at once."},
    ProblemType{"range-not-satisfiable", 416, "Range Not Satisfiable",
                "The field Content-Range has the number of bytes there are."},
    ProblemType{"expectation-failed", 417, "Expectation Failed", "Only 100-continue is known."},
    ProblemType{"header-too-large", 431, "Request Header Fields Too Large", "Send fewer or shorter fields."},
    ProblemType{"internal-error", 500, "Internal Server Error",
                "The server failed; its log may say why. Nothing is wrong with the request."},
    ProblemType{"not-implemented", 501, "Not Implemented", "The method or transfer coding is not known."},
    ProblemType{"service-unavailable", 503, "Service Unavailable",
                "The server is busy or about to end; the field Retry-After has the seconds to wait."},
    ProblemType{"version-not-supported", 505, "HTTP Version Not Supported", "HTTP/1.0 and HTTP/1.1 are."},
};

} // namespace

namespace problem_types {
const ProblemType unknownParameter{"unknown-parameter", 400, "Unknown parameter",
                                   "The endpoint has no parameter of this name; /api/v1/openapi.json lists "
                                   "those it has."};
const ProblemType invalidParameter{"invalid-parameter", 400, "Invalid parameter",
                                   "The value of a parameter can't be read, or is outside what is allowed."};
const ProblemType missingParameter{"missing-parameter", 400, "Missing parameter",
                                   "The endpoint needs a parameter that the request lacks."};
const ProblemType noSuchCloud{"no-such-cloud", 404, "No such cloud",
                              "The server has no cloud of this id; /api/v1/clouds lists those it has."};
const ProblemType noSuchNode{"no-such-node", 404, "No such node",
                             "The cloud has no node of this key, or none with a chunk of its own."};
const ProblemType notAcceptable{"not-acceptable", 406, "Not Acceptable",
                                "None of the formats that the endpoint has is asked for; `available` has "
                                "them all."};
const ProblemType versionGone{"version-gone", 410, "Gone",
                              "The cloud has been replaced since, and this version of it is gone; "
                              "/api/v1/clouds/ID has the version that there is."};
const ProblemType workTooLarge{"work-too-large", 400, "Too much work",
                               "The answer would take more than the server gives to one request; ask for "
                               "less."};
const ProblemType cloudUnusable{"cloud-unusable", 503, "Cloud unusable",
                                "The cloud's file is damaged, cut, or being replaced."};
const ProblemType cloudChanged{"cloud-changed", 503, "Cloud changed",
                               "The cloud was replaced while the answer was being made; ask again."};
const ProblemType upstreamFailed{"upstream-failed", 502, "Upstream failed",
                                 "The server that the cloud comes from can't be reached or gave no usable "
                                 "answer."};
const ProblemType upstreamTimedOut{"upstream-timed-out", 504, "Upstream timed out",
                                   "The server that the cloud comes from did not answer in time."};
const ProblemType outOfTime{"out-of-time", 503, "Out of time",
                            "The answer took longer than the server gives to one request; ask for less."};
const ProblemType tooManyRequests{"too-many-requests", 429, "Too Many Requests",
                                  "This client asks faster than the server allows; the field Retry-After "
                                  "has the seconds to wait."};
} // namespace problem_types

std::span<const ProblemType> problemTypes() {
    using namespace problem_types;
    static const std::vector<ProblemType> all = [] {
        std::vector<ProblemType> types(general.begin(), general.end());
        types.insert(types.end(),
                     {unknownParameter, invalidParameter, missingParameter, noSuchCloud, noSuchNode,
                      notAcceptable, versionGone, workTooLarge, cloudUnusable, cloudChanged, upstreamFailed,
                      upstreamTimedOut, outOfTime, tooManyRequests});
        return types;
    }();
    return all;
}

std::string problemAddress(const ProblemType& type) {
    return cat("/api/v1/problems/", type.name);
}

HttpResponse problemResponse(const Problem& problem) {
    Json document{{"type", problemAddress(problem.type)},
                  {"title", problem.type.title},
                  {"status", problem.type.status},
                  {"detail", problem.detail}};
    if (!problem.parameter.empty())
        document["parameter"] = problem.parameter;
    if (!problem.available.empty())
        document["available"] = problem.available;
    HttpResponse response;
    response.status = problem.type.status;
    response.set("Content-Type", problemMediaType);
    response.set("Cache-Control", "no-store");
    response.body.push_back(textOf(document));
    return response;
}

HttpResponse problemResponse(int status, const std::string& detail) {
    auto hasStatus = [](int wanted) {
        return [wanted](const ProblemType& type) { return type.status == wanted; };
    };
    auto found = std::find_if(general.begin(), general.end(), hasStatus(status));
    if (found == general.end()) // a status without a type would be a mistake of ours, not of the client
        found = std::find_if(general.begin(), general.end(), hasStatus(500));
    return problemResponse({*found, detail});
}

HttpResponse parameterProblem(const Error& error) {
    return problemResponse({problem_types::invalidParameter, error.sentence(), error.where});
}

HttpResponse problemResponse(const Error& error) {
    switch (error.code) {
    case ErrorCode::notFound:
    case ErrorCode::invalidArgument:
        return problemResponse(404, "there is nothing at this address");
    case ErrorCode::outOfMemory:
    case ErrorCode::limitExceeded: {
        HttpResponse response = problemResponse(503, "the server is too busy to open the file");
        response.set("Retry-After", "1");
        return response;
    }
    default:
        return problemResponse(500, "the file can't be read");
    }
}

HttpResponse jobProblem(const Error& error) {
    using namespace problem_types;
    switch (error.code) {
    case ErrorCode::notFound:
        return problemResponse({noSuchNode, error.what});
    case ErrorCode::invalidArgument:
    case ErrorCode::outOfRange:
        return problemResponse({invalidParameter, error.what});
    case ErrorCode::limitExceeded:
    case ErrorCode::outOfMemory:
        return problemResponse({workTooLarge, error.what});
    case ErrorCode::cancelled:
        return problemResponse({outOfTime, "the answer took longer than the server gives to one request"});
    case ErrorCode::networkFailed:
    case ErrorCode::accessDenied: {
        HttpResponse response =
            problemResponse({isTimeout(error) ? upstreamTimedOut : upstreamFailed, error.what});
        response.set("Retry-After", "5");
        return response;
    }
    case ErrorCode::changed: {
        HttpResponse response =
            problemResponse({cloudChanged, "the cloud was replaced meanwhile; ask again"});
        response.set("Retry-After", "0");
        return response;
    }
    case ErrorCode::truncated:
    case ErrorCode::corrupt:
    case ErrorCode::unsupported:
        return problemResponse({cloudUnusable, cat("the file of this cloud can't be used: ", error.what)});
    default:
        return problemResponse(500, "the file can't be read");
    }
}

HttpResponse methodNotAllowed(std::string_view method, const std::string& allow) {
    static constexpr std::array<std::string_view, 9> known{"GET",     "HEAD",    "POST",  "PUT",  "DELETE",
                                                           "CONNECT", "OPTIONS", "TRACE", "PATCH"};
    bool isKnown = std::find(known.begin(), known.end(), method) != known.end();
    HttpResponse response = isKnown ? problemResponse(405, cat("the method ", method, " is not allowed here"))
                                    : problemResponse(501, "the method is not known");
    if (isKnown)
        response.set("Allow", allow);
    return response;
}

void setProblemInstance(HttpResponse& response, std::string_view target) {
    if (response.field("Content-Type") != problemMediaType || response.body.size() != 1 || target.empty())
        return;
    auto& text = std::get<std::string>(response.body.front());
    Json document = Json::parse(text, nullptr, false);
    document["instance"] = std::string(target.substr(0, target.find('?')));
    text = textOf(document);
}

} // namespace stipple::server
