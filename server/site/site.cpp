#include "server/site/site.hpp"

#include "server/api/api.hpp"
#include "server/api/picture_service.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "server/site/cloud_address.hpp"
#include "server/site/cloud_problem.hpp"
#include "server/site/request_rules.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

constexpr const char* allowedMethods = "GET, HEAD, OPTIONS";
constexpr const char* revalidated = "no-cache";

bool isRead(const HttpRequest& request) {
    return request.method == "GET" || request.method == "HEAD";
}

// For what needs credentials: no cache that others use may keep it (RFC 9111 §5.2.2.7).
std::string privateCaching(std::string value) {
    constexpr std::string_view forAll = "public";
    if (value.find("no-store") != std::string::npos || value.find("private") != std::string::npos)
        return value;
    if (std::size_t at = value.find(forAll); at != std::string::npos)
        return value.replace(at, forAll.size(), "private");
    return value.empty() ? "private" : cat("private, ", value);
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
    bool forAll = isForAll(request, response);
    if (request.target.size() <= maxTargetBytes) // a longer one is refused, not sent back
        setProblemInstance(response, request.target);
    cors_.complete(request, response, forAll);
    if (!forAll)
        response.set("Cache-Control", privateCaching(response.field("Cache-Control")));
    if (response.field("Cross-Origin-Resource-Policy").empty())
        response.set("Cross-Origin-Resource-Policy", forAll ? "cross-origin" : "same-origin");
    response.set("X-Content-Type-Options", "nosniff");
    if (request.method == "HEAD")
        response.sendsBody = false;
}

std::string Site::userOf(const HttpRequest& request) const {
    auto rules = this->rules();
    if (!rules || request.count("Authorization") == 0)
        return {};
    constexpr std::int64_t beforeAnyExpiry =
        0; // whose token it was is worth knowing when it has expired, too
    return Visitor(std::move(rules), request, "", beforeAnyExpiry).name();
}

// Whether the response says nothing that needs credentials. It must not depend on whether a cloud exists or
// is private where the client may not know that: what is refused before the clouds are looked at is for all,
// what is refused for lack of rights never is.
bool Site::isForAll(const HttpRequest& request, const HttpResponse& response) const {
    auto rules = this->rules();
    if (!rules || !rules->hidesAny())
        return true;
    if (!response.field("WWW-Authenticate").empty())
        return false;
    if (!isRead(request) || response.closes)
        return true;
    auto target = parseTarget(request.target);
    if (!target)
        return true;
    if (isCloudList(*target))
        return request.count("Authorization") == 0 && !parseAddressSignature(target->query).isPresent;
    auto id = cloudIdOf(*target);
    return !id || !rules->isPrivate(*id);
}

Answer Site::route(const HttpRequest& request, std::int64_t nowSeconds) const {
    if (request.method == "OPTIONS" && request.target == "*")
        return preflightResponse(allowedMethods);
    if (request.target.size() > maxTargetBytes)
        return problemResponse(414, cat("the target is longer than ", maxTargetBytes, " bytes"));
    auto target = parseTarget(request.target);
    if (!target)
        return problemResponse(400, target.error().what);
    if (request.method == "OPTIONS")
        return preflightResponse(allowedMethods);
    if (!isRead(request))
        return methodNotAllowed(request.method, allowedMethods);
    return routeRead(request, std::move(*target), nowSeconds);
}

// Rights come before everything that depends on a cloud: conditions, ranges, parameters, whether it exists.
Answer Site::routeRead(const HttpRequest& request, Target target, std::int64_t nowSeconds) const {
    Visitor visitor(rules(), request, target.query, nowSeconds);
    target.query = withoutSignature(target.query);
    auto id = cloudIdOf(target);
    std::optional<HttpResponse> refusal;
    if (id)
        refusal = visitor.refusal(*id, catalog_->holds(*id));
    else if (isCloudList(target))
        refusal = visitor.refusalOfList();
    if (refusal)
        return std::move(*refusal);

    if (isApiPath(target))
        return answerApi(request, target, {*catalog_, *resources_, visitor}, nowSeconds);
    if (id)
        return answerFile(request, *id, nowSeconds);
    if (!target.segments.empty() && (target.segments[0] == "api" || target.segments[0] == "clouds"))
        return problemResponse(404, "there is nothing at this address");
    return page_.answer(request, target, nowSeconds);
}

HttpResponse Site::answerFile(const HttpRequest& request, const std::string& id,
                              std::int64_t nowSeconds) const {
    auto version = catalog_->current(id);
    if (!version)
        return cloudProblem(version.error());
    return answerRepresentation(
        request, Representation::ofFile((*version)->file, "application/octet-stream", revalidated),
        nowSeconds);
}

std::vector<Measurement> Site::measurements() const {
    std::vector<Measurement> all{
        {"stipple_build_info", "1; the label says which version", false, 1, {{"version", STIPPLE_VERSION}}},
        {"stipple_clouds", "Clouds that are offered", false, static_cast<double>(catalog_->ids().size())}};
    auto addCache = [&all](const char* name, const CacheCounts& counts) {
        auto add = [&](const char* what, const char* help, bool isCounter, std::uint64_t value) {
            all.push_back({cat("stipple_cache_", what),
                           help,
                           isCounter,
                           static_cast<double>(value),
                           {{"cache", name}}});
        };
        add("hits_total", "Values that were there", true, counts.hits);
        add("misses_total", "Values that were made", true, counts.misses);
        add("waits_total", "Values that another request was making already", true, counts.waits);
        add("evicted_total", "Values that left for others", true, counts.evicted);
        add("bytes", "Held", false, counts.bytes);
    };
    addCache("hierarchy", resources_->hierarchy.counts());
    addCache("pictures", resources_->pictures().counts());
    return all;
}

} // namespace stipple::server
