#include "server/site/site.hpp"

#include "server/api/api.hpp"
#include "server/api/picture_service.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "server/site/cloud_address.hpp"
#include "server/site/cloud_problem.hpp"
#include "server/site/request_rules.hpp"
#include "server/upstream/range_writer.hpp"
#include "shared/base/text.hpp"

namespace stipple::server {

namespace {

constexpr const char* allowedMethods = "GET, HEAD, OPTIONS";
constexpr const char* revalidated = "no-cache";
constexpr const char* cloudType = "application/octet-stream";

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

// Reading nodes of a cloud at another server is waiting for it, and copying; the rest of the API computes.
bool isTransfer(const Job& job) {
    return job.kind == "hierarchy" || job.kind == "node" || job.kind == "batch";
}

} // namespace

Answer Site::answer(const HttpRequest& request, std::int64_t nowSeconds) const {
    Answer answer;
    if (auto refusal = checkRequestRules(request))
        answer = std::move(*refusal);
    else
        answer = route(request, nowSeconds, MayWait::no);
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
        response.set("Cross-Origin-Resource-Policy",
                     forAll && cors_.isPublicForAll() ? "cross-origin" : "same-origin");
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

Answer Site::route(const HttpRequest& request, std::int64_t nowSeconds, MayWait mayWait) const {
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
    return routeRead(request, std::move(*target), nowSeconds, mayWait);
}

// Rights come before everything that depends on a cloud: conditions, ranges, parameters, whether it exists.
Answer Site::routeRead(const HttpRequest& request, Target target, std::int64_t nowSeconds,
                       MayWait mayWait) const {
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

    if (id && mayWait == MayWait::no && catalog_->mustBePrepared(*id))
        return answerByJob(request, *id, nowSeconds);
    if (isApiPath(target)) {
        Answer answer = answerApi(request, target, {*catalog_, *resources_, visitor}, nowSeconds);
        if (auto* job = std::get_if<Job>(&answer); job != nullptr && id && catalog_->isElsewhere(*id))
            job->isTransfer = isTransfer(*job);
        return answer;
    }
    if (id)
        return answerFile(request, *id, nowSeconds, mayWait);
    if (!target.segments.empty() && (target.segments[0] == "api" || target.segments[0] == "clouds"))
        return problemResponse(404, "there is nothing at this address");
    return page_.answer(request, target, nowSeconds);
}

Answer Site::answerFile(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds,
                        MayWait mayWait) const {
    auto found = catalog_->current(id);
    if (!found)
        return cloudProblem(found.error());
    const CloudVersion& version = **found;
    if (version.file)
        return answerRepresentation(request, Representation::ofFile(version.file, cloudType, revalidated),
                                    nowSeconds);
    Representation elsewhere{Representation::Elsewhere{version.sizeBytes()}, cloudType, revalidated,
                             version.validators};
    HttpResponse response = answerRepresentation(request, elsewhere, nowSeconds);
    if (request.method == "HEAD" || !needsBytes(response) || fillFromHeld(response, *version.upstream))
        return response;
    if (mayWait == MayWait::no)
        return answerByJob(request, id, nowSeconds);
    auto work = [upstream = version.upstream, response = std::move(response)](AnswerWriter& writer) {
        return writeRanges(response, *upstream, writer);
    };
    return Job{"upstream", std::move(work), nullptr, true};
}

// Of a cloud at another server, whose answer has to wait for it.
Job Site::answerByJob(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds) const {
    auto work = [this, kept = std::make_shared<const KeptRequest>(request), id, nowSeconds](
                    AnswerWriter& writer) { return answerWaiting(kept->request(), id, nowSeconds, writer); };
    return Job{"upstream", std::move(work), nullptr, true};
}

// If the cloud turns out to have been replaced, the request is put to the new version: a client that asks
// for the old one gets 412, others the new one.
Status Site::answerWaiting(const HttpRequest& request, const std::string& id, std::int64_t nowSeconds,
                           AnswerWriter& writer) const {
    for (bool isLast = false;; isLast = true) {
        catalog_->prepare(id, writer.isStopped());
        Answer answer = route(request, nowSeconds, MayWait::yes);
        if (auto* response = std::get_if<HttpResponse>(&answer)) {
            writer.answer(std::move(*response));
            return {};
        }
        Job& job = std::get<Job>(answer);
        if (!job.isTransfer) {
            writer.handOver(std::move(job));
            return {};
        }
        Status status = job.run(writer);
        if (status || status.error().code != ErrorCode::changed || isLast)
            return status;
    }
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
    addCache("statistics", resources_->statistics.counts());
    if (const Upstream* upstream = catalog_->upstream()) {
        addCache("upstream", upstream->blocks.counts());
        if (upstream->disk)
            addCache("upstream-disk", upstream->disk->counts());
        for (Measurement& more : upstream->measurements())
            all.push_back(std::move(more));
    }
    return all;
}

} // namespace stipple::server
