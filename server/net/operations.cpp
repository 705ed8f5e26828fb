#include "server/net/operations.hpp"

#include "server/http/problem.hpp"
#include "server/net/metrics_text.hpp"
#include "server/site/request_rules.hpp"

namespace stipple::server {

namespace {

HttpResponse ok() {
    HttpResponse response;
    response.set("Content-Type", "application/json");
    response.body.push_back(std::string("{\"status\":\"ok\"}\n"));
    return response;
}

bool isAtALimit(ServerState& state) {
    return state.connections.all() >= state.limits.connections ||
           state.jobs.counts().queued >= state.jobs.limits().queued;
}

// A proxy on this machine is local, too; what it passes on for others usually says so.
bool isLocal(const HttpRequest& request, const net::ip::address& peer) {
    bool isForwarded =
        request.count("X-Forwarded-For") + request.count("Forwarded") + request.count("Via") > 0;
    net::ip::address address = peer;
    if (address.is_v6() && address.to_v6().is_v4_mapped())
        address = net::ip::make_address_v4(net::ip::v4_mapped, address.to_v6());
    return address.is_loopback() && !isForwarded;
}

bool mayReadMetrics(const HttpRequest& request, const ServerState& state, const net::ip::address& peer) {
    return state.metricsFor == MetricsFor::everyone ||
           (state.metricsFor == MetricsFor::thisMachine && isLocal(request, peer));
}

std::vector<Measurement> measurements(ServerState& state) {
    JobCounts jobs = state.jobs.counts(), transfers = state.transfers.counts();
    auto gauge = [](const char* name, const char* help, double value) {
        return Measurement{name, help, false, value};
    };
    auto counter = [](const char* name, const char* help, std::uint64_t value) {
        return Measurement{name, help, true, static_cast<double>(value)};
    };
    std::vector<Measurement> all{
        gauge("stipple_http_connections_open", "Connections of clients", state.connections.all()),
        gauge("stipple_http_connections_max", "Most that are accepted", state.limits.connections),
        counter("stipple_http_connections_refused_total", "Connections beyond their client's share",
                state.connections.refused()),
        gauge("stipple_jobs_running", "Jobs that run", jobs.running),
        gauge("stipple_jobs_queued", "Jobs that wait for their turn", jobs.queued),
        counter("stipple_jobs_accepted_total", "Jobs that were accepted", jobs.accepted),
        counter("stipple_jobs_refused_total", "Jobs beyond a limit", jobs.refused),
        counter("stipple_jobs_cancelled_total", "Jobs whose client left, or whose time was over",
                jobs.cancelled),
        gauge("stipple_transfers_running", "Answers that are made of another server's", transfers.running),
        gauge("stipple_transfers_queued", "Of those, that wait for their turn", transfers.queued),
        counter("stipple_transfers_refused_total", "Of those, beyond a limit", transfers.refused)};
    for (Measurement& more : state.handler->measurements())
        all.push_back(std::move(more));
    for (Measurement& more : processMeasurements())
        all.push_back(std::move(more));
    return all;
}

HttpResponse metrics(ServerState& state) {
    RequestTotals totals;
    for (const RequestMetrics* ofLoop : state.metrics)
        totals.add(ofLoop->totals());
    HttpResponse response;
    response.set("Content-Type", metricsMediaType);
    response.body.push_back(metricsText(totals, measurements(state)));
    return response;
}

HttpResponse answerHealth(ServerState& state, bool asksWhetherReady) {
    if (state.isEnding)
        return problemResponse(503, "the server is about to end");
    if (asksWhetherReady && isAtALimit(state))
        return problemResponse(503, "the server has too much to do");
    return ok();
}

} // namespace

std::optional<HttpResponse> answerOperations(const HttpRequest& request, ServerState& state,
                                             const net::ip::address& peer) {
    if (routeOf(request.target) != Route::operations || checkRequestRules(request) ||
        (request.method != "GET" && request.method != "HEAD"))
        return std::nullopt;
    bool asksForMetrics = request.target.starts_with("/metrics");
    if (asksForMetrics && !mayReadMetrics(request, state, peer))
        return std::nullopt;
    HttpResponse response =
        asksForMetrics ? metrics(state) : answerHealth(state, request.target.starts_with("/readyz"));
    response.set("Cache-Control", "no-store");
    state.handler->complete(request, response);
    return response;
}

} // namespace stipple::server
