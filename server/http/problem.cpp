#include "server/http/problem.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

nlohmann::ordered_json documentOf(int status, const std::string& detail) {
    return {{"title", reasonPhrase(status)}, {"status", status}, {"detail", detail}};
}

HttpResponse responseWith(int status, const nlohmann::ordered_json& document) {
    HttpResponse response;
    response.status = status;
    response.set("Content-Type", "application/problem+json");
    response.set("Cache-Control", "no-store");
    // `replace`: a detail may quote bytes of the request that are no UTF-8.
    response.body.push_back(document.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
                            "\n");
    return response;
}

} // namespace

HttpResponse problemResponse(int status, const std::string& detail) {
    return responseWith(status, documentOf(status, detail));
}

HttpResponse parameterProblem(const Error& error) {
    nlohmann::ordered_json document = documentOf(400, error.sentence());
    if (!error.where.empty())
        document["parameter"] = error.where;
    return responseWith(400, document);
}

HttpResponse problemResponse(const Error& error) {
    switch (error.code) {
    case ErrorCode::notFound:
    case ErrorCode::invalidArgument:
        return problemResponse(404, "there is nothing at this address");
    case ErrorCode::limitExceeded: {
        HttpResponse response = problemResponse(503, "the server is too busy to open the file");
        response.set("Retry-After", "1");
        return response;
    }
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

} // namespace stipple::server
