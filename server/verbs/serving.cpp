#include "server/verbs/serving.hpp"

#include "server/net/server.hpp"
#include "server/net/signals.hpp"
#include "server/site/cloud_address.hpp"
#include "server/site/site.hpp"

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

void printAddress(const Server& server, const Site& site, bool asJson) {
    const auto& ids = site.catalog().ids();
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

CLI::Option* addSeconds(CLI::App& verb, const std::string& name, std::chrono::milliseconds& limit,
                        const std::string& help) {
    return verb
        .add_option_function<double>(
            name,
            [&limit](double seconds) {
                limit = std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
            },
            help)
        ->check(CLI::Range(0.001, 86400.0))
        ->default_str(std::to_string(limit.count() / 1000));
}

void addLimitOptions(CLI::App& verb, ServerLimits& limits) {
    const char* group = "Limits";
    verb.add_option("--jobs", limits.jobs.working,
                    "Jobs (exports, pictures) that compute at once; 0: one for each core, 2 to 8")
        ->check(CLI::Range(0, 256))
        ->capture_default_str()
        ->group(group);
    verb.add_option("--jobs-per-client", limits.jobs.perClient,
                    "Jobs of one client, waiting or running; more are refused (429)")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str()
        ->group(group);
    verb.add_option("--job-queue", limits.jobs.queued, "Jobs that may wait; more are refused (503)")
        ->check(CLI::Range(1, 100'000))
        ->capture_default_str()
        ->group(group);
    addSeconds(verb, "--job-seconds", limits.jobs.work, "Seconds that a job may compute")->group(group);
}

} // namespace

void addServingOptions(CLI::App& verb, ServingOptions& options) {
    verb.add_option("--host", options.host,
                    "Address to listen on; 0.0.0.0 lets other machines in (no password, no encryption)")
        ->capture_default_str();
    verb.add_option("--port", options.port, "Port to listen on; 0: any free one")->capture_default_str();
    verb.add_option("--page", options.pageFolder, "Folder of the built page");
    verb.add_flag("--json", options.asJson, "Print the address and the clouds as one line of JSON");
    verb.add_flag("--log", options.logsRequests, "Print a line for each request to standard error");
    verb.add_option("--grace", options.graceSeconds, "Seconds that downloads may go on after Ctrl-C")
        ->check(CLI::Range(0, 86400))
        ->capture_default_str();
    addLimitOptions(verb, options.limits);
}

int serveUntilSignalled(const char* verb, const ServingOptions& options,
                        const std::vector<std::string>& paths,
                        const std::function<void(const std::string&)>& onReady) {
    raiseDescriptorLimit();
    auto opened = CloudCatalog::open(paths);
    if (!opened)
        return cli::fail(verb, opened.error());
    for (const Error& warning : opened->warnings)
        std::fprintf(stderr, "stipple %s: left out: %s\n", verb, warning.sentence().c_str());
    auto page = openPageFolder(options.pageFolder);
    if (!page)
        return cli::fail(verb, page.error());
    auto site = std::make_shared<const Site>(std::move(opened->catalog), Page(std::move(*page)));

    RequestLog log;
    if (options.logsRequests)
        log = [](const RequestRecord& record) { std::fprintf(stderr, "%s\n", formatRecord(record).c_str()); };
    ServerOptions serverOptions;
    serverOptions.host = options.host;
    serverOptions.port = options.port;
    serverOptions.limits = options.limits;
    StopSignals signals;
    auto server = Server::start(serverOptions, site, log);
    if (!server)
        return cli::fail(verb, server.error());
    printAddress(**server, *site, options.asJson);
    onReady((*server)->address());
    signals.runUntilSignalled(**server, std::chrono::seconds(options.graceSeconds));
    return cli::success;
}

} // namespace stipple::server
