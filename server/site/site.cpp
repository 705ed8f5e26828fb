#include "server/site/site.hpp"

#include "server/api/api.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "server/site/cloud_problem.hpp"
#include "server/site/request_rules.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

constexpr const char* allowedMethods = "GET, HEAD, OPTIONS";
constexpr const char* revalidated = "no-cache";
constexpr std::string_view fileSuffix = ".stipple";

// On every status: a browser hides a 404 or 412 without them as it would hide a 200 (Fetch standard, CORS
// protocol). Clouds are public to whoever reaches the server, so any origin may read them.
void setCommonFields(HttpResponse& response) {
    response.set("Access-Control-Allow-Origin", "*");
    response.set("Access-Control-Expose-Headers",
                 "Accept-Ranges, Content-Length, Content-Range, ETag, Last-Modified");
    response.set("Cross-Origin-Resource-Policy", "cross-origin");
    response.set("X-Content-Type-Options", "nosniff");
}

// Also the preflight: which fields a cross-origin request may carry, remembered for two hours.
HttpResponse answerOptions() {
    HttpResponse response;
    response.status = 204;
    response.set("Allow", allowedMethods);
    response.set("Access-Control-Allow-Methods", allowedMethods);
    response.set("Access-Control-Allow-Headers",
                 "Range, If-Range, If-Match, If-None-Match, If-Modified-Since, If-Unmodified-Since");
    response.set("Access-Control-Max-Age", "7200");
    return response;
}

} // namespace

Answer Site::answer(const HttpRequest& request, std::int64_t nowSeconds) const {
    Answer answer;
    if (auto refusal = checkRequestRules(request))
        answer = std::move(*refusal);
    else
        answer = route(request, nowSeconds);
    if (auto* response = std::get_if<HttpResponse>(&answer))
        complete(request, *response);
    return answer;
}

void Site::complete(const HttpRequest& request, HttpResponse& response) const {
    setProblemInstance(response, request.target);
    setCommonFields(response);
    if (request.method == "HEAD")
        response.sendsBody = false;
}

Answer Site::route(const HttpRequest& request, std::int64_t nowSeconds) const {
    if (request.method == "OPTIONS" && request.target == "*")
        return answerOptions();
    if (request.target.size() > maxTargetBytes)
        return problemResponse(414, cat("the target is longer than ", maxTargetBytes, " bytes"));
    auto target = parseTarget(request.target);
    if (!target)
        return problemResponse(400, target.error().what);
    if (request.method == "OPTIONS")
        return answerOptions();
    if (request.method != "GET" && request.method != "HEAD")
        return methodNotAllowed(request.method, allowedMethods);

    const std::vector<std::string>& path = target->segments;
    if (isApiPath(*target))
        return answerApi(request, *target, *catalog_, nowSeconds);
    if (path.size() == 2 && path[0] == "clouds")
        return answerFile(request, path[1], nowSeconds);
    if (!path.empty() && (path[0] == "api" || path[0] == "clouds"))
        return problemResponse(404, "there is nothing at this address");
    return page_.answer(request, *target, nowSeconds);
}

HttpResponse Site::answerFile(const HttpRequest& request, std::string_view name,
                              std::int64_t nowSeconds) const {
    if (!name.ends_with(fileSuffix))
        return problemResponse(404, "there is nothing at this address");
    auto version = catalog_->current(name.substr(0, name.size() - fileSuffix.size()));
    if (!version)
        return cloudProblem(version.error());
    return answerRepresentation(
        request, Representation::ofFile((*version)->file, "application/octet-stream", revalidated),
        nowSeconds);
}

} // namespace stipple::server
