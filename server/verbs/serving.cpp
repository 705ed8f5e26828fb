#include "server/verbs/serving.hpp"

#include "server/net/server.hpp"
#include "server/net/signals.hpp"
#include "server/site/cloud_address.hpp"
#include "server/site/site.hpp"
#include "server/verbs/net_options.hpp"
#include "shared/cli/number_check.hpp"

#include <chrono>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace stipple::server {

namespace {

// A connection is a descriptor; many systems start programs with 1024 of them but allow more.
void raiseDescriptorLimit() {
    struct rlimit limit {};
    if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
        limit.rlim_cur = limit.rlim_max;
        ::setrlimit(RLIMIT_NOFILE, &limit);
    }
}

// Behind a proxy, others are served from a loopback address, too.
bool isForThisMachine(const ServerOptions& options) {
    const std::string& host = options.host;
    bool isLoopback = host == "localhost" || host == "::1" || host.starts_with("127.");
    return isLoopback && options.trustedProxies.empty();
}

void printAddress(const Server& server, const Site& site, bool asJson) {
    const std::vector<std::string> ids = site.catalog().ids();
    if (asJson) {
        nlohmann::ordered_json clouds = nlohmann::ordered_json::array();
        for (const std::string& id : ids)
            clouds.push_back({{"id", id}, {"address", server.address() + cloudAddress(id).substr(1)}});
        nlohmann::ordered_json line{
            {"address", server.address()}, {"port", server.port()}, {"clouds", std::move(clouds)}};
        std::printf("%s\n", line.dump().c_str());
    } else {
        std::printf("Serving %zu cloud%s at %s (Ctrl-C ends)\n", ids.size(), ids.size() == 1 ? "" : "s",
                    server.address().c_str());
    }
    std::fflush(stdout);
}

// What SIGHUP asks for. What can't be read is said, and the old one stays in use.
void reload(const char* verb, Server& server, const Site& site, AccessLog* log) {
    site.catalog().reload();
    AccessControl* access = site.access();
    Upstream* upstream = site.catalog().upstream();
    for (const Status& status : {server.reloadCertificate(), access != nullptr ? access->reload() : Status(),
                                 upstream != nullptr ? upstream->reloadTokens() : Status(),
                                 log != nullptr ? log->reopen() : Status()})
        if (!status)
            std::fprintf(stderr, "stipple %s: not reloaded: %s\n", verb, status.error().sentence().c_str());
}

} // namespace

void addServingOptions(CLI::App& verb, ServingOptions& options) {
    addNetOptions(verb, options.server);
    addSiteOptions(verb, options.site);
    verb.add_flag("--json", options.asJson, "Print the address and the clouds as one line of JSON");
    verb.add_option("--grace", options.graceSeconds, "Seconds that downloads may go on after Ctrl-C")
        ->check(cli::wholeNumber(0, 86400))
        ->capture_default_str();
    verb.add_option("--notice", options.noticeSeconds,
                    "Seconds for which /healthz says 503 after Ctrl-C before connections are refused")
        ->check(cli::wholeNumber(0, 86400))
        ->capture_default_str();
}

int serveUntilSignalled(const char* verb, const ServingOptions& options,
                        const std::vector<std::string>& paths,
                        const std::function<void(const std::string&)>& onReady) {
    raiseDescriptorLimit();
    auto opened = CloudCatalog::open(paths, {}, options.site.upstream);
    if (!opened)
        return cli::fail(verb, opened.error());
    for (const Error& warning : opened->warnings)
        std::fprintf(stderr, "stipple %s: warning: %s\n", verb, warning.sentence().c_str());
    auto page = openPageFolder(options.site.pageFolder);
    if (!page)
        return cli::fail(verb, page.error());
    auto chosen = siteOptions(options.site, isForThisMachine(options.server));
    if (!chosen)
        return cli::fail(verb, chosen.error());
    auto site =
        std::make_shared<const Site>(std::move(opened->catalog), Page(std::move(*page)), std::move(*chosen));
    auto accessLog = openLog(options.site);
    if (!accessLog)
        return cli::fail(verb, accessLog.error());

    AccessLog* log = accessLog->get();
    RequestLog logRequest;
    if (log != nullptr)
        logRequest = [log](const RequestRecord& record) { log->write(record); };
    ServerSignals signals;
    auto server = Server::start(options.server, site, logRequest);
    if (!server)
        return cli::fail(verb, server.error());
    printAddress(**server, *site, options.asJson);
    onReady((*server)->address());
    std::function<void()> onHangUp;
    if (options.reloadsOnHangUp)
        onHangUp = [&] { reload(verb, **server, *site, log); };
    signals.runUntilSignalled(**server, std::chrono::seconds(options.noticeSeconds),
                              std::chrono::seconds(options.graceSeconds), onHangUp);
    return cli::success;
}

} // namespace stipple::server
