#include "server/verbs/net_options.hpp"

#include "shared/cli/number_check.hpp"

#include <chrono>
#include <map>
#include <string>

namespace stipple::server {

namespace {

using Milliseconds = std::chrono::milliseconds;

CLI::Option* addSeconds(CLI::App& verb, const std::string& name, Milliseconds& limit,
                        const std::string& help) {
    auto set = [&limit](double seconds) { limit = Milliseconds(static_cast<std::int64_t>(seconds * 1000)); };
    return verb.add_option_function<double>(name, set, help)
        ->check(cli::number(0.001, 86400))
        ->default_str(std::to_string(limit.count() / 1000));
}

template <class Number>
CLI::Option* addCount(CLI::App& verb, const std::string& name, Number& limit, int least,
                      const std::string& help) {
    return verb.add_option(name, limit, help)
        ->check(cli::wholeNumber(least, 10'000'000))
        ->capture_default_str();
}

void addLimitOptions(CLI::App& verb, ServerLimits& limits) {
    auto setRate = [&limits](double bytesPerSecond) {
        limits.noProgress =
            Milliseconds(static_cast<std::int64_t>(1000.0 * ServerLimits::progressBytes / bytesPerSecond));
    };
    CLI::Option* rate =
        verb.add_option_function<double>("--slowest", setRate,
                                         "Bytes a second; a client that reads an answer more slowly is cut")
            ->check(cli::number(1, 1e9))
            ->default_str("8738");
    for (CLI::Option* option :
         {addCount(verb, "--connections", limits.connections, 1,
                   "Connections open at once; more wait (the system's limit on descriptors holds, too)"),
          addCount(verb, "--connections-per-client", limits.connectionsPerClient, 1,
                   "Connections of one address; more are closed"),
          addSeconds(verb, "--idle-seconds", limits.idle, "Seconds that a connection may be idle"),
          addSeconds(verb, "--header-seconds", limits.header,
                     "Seconds for a request's header or a TLS handshake"),
          rate,
          addCount(verb, "--jobs", limits.jobs.working, 0,
                   "Jobs (exports, pictures) that compute at once; 0: one for each core, 2 to 8"),
          addCount(verb, "--jobs-per-client", limits.jobs.perClient, 1,
                   "Jobs of one client, waiting or running; more are refused (429)"),
          addCount(verb, "--job-queue", limits.jobs.queued, 1, "Jobs that may wait; more are refused (503)"),
          addSeconds(verb, "--job-seconds", limits.jobs.work, "Seconds that a job may compute")})
        option->group("Limits");
}

} // namespace

void addNetOptions(CLI::App& verb, ServerOptions& options) {
    options.port = 8017;
    verb.add_option("--host", options.host,
                    "Address to listen on; 0.0.0.0 lets other machines in (see --cert)")
        ->capture_default_str();
    verb.add_option("--port", options.port, "Port to listen on; 0: any free one")
        ->check(cli::wholeNumber(0, 65535))
        ->capture_default_str();
    CLI::Option* certificate = verb.add_option(
        "--cert", options.certificatePath, "Serve https: PEM file of the certificate and those it rests on");
    CLI::Option* key = verb.add_option("--key", options.keyPath, "PEM file of the certificate's private key");
    certificate->needs(key);
    key->needs(certificate);
    const std::map<std::string, MetricsFor> readers{
        {"off", MetricsFor::nobody}, {"local", MetricsFor::thisMachine}, {"all", MetricsFor::everyone}};
    verb.add_option("--metrics", options.metrics,
                    "Who may read /metrics (Prometheus): off, local (clients of this machine) or all")
        ->transform(CLI::CheckedTransformer(readers))
        ->default_str("off");
    verb.add_option(
        "--trust-proxy", options.trustedProxies,
        "Addresses of proxies that name their clients in X-Forwarded-For; their connections are not "
        "limited");
    addLimitOptions(verb, options.limits);
}

} // namespace stipple::server
