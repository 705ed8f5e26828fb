#include "server/verbs/site_options.hpp"

#include "server/upstream/upstream_tokens.hpp"

namespace stipple::server {

namespace {

// "2G" is 2 × 2^30.
CLI::Option* addBytes(CLI::App& verb, const char* name, std::uint64_t& bytes, const char* help) {
    return verb.add_option(name, bytes, help)->transform(CLI::AsSizeValue(false))->group("Limits");
}

void addApiOptions(CLI::App& verb, ApiLimits& limits) {
    verb.add_option("--answer-points", limits.points.maxPoints,
                    "Points that one answer of /points or /profile may have; more are refused (400)")
        ->check(CLI::Range(std::uint64_t{1}, std::uint64_t{1} << 53))
        ->capture_default_str()
        ->group("Limits");
    addBytes(verb, "--answer-bytes", limits.points.maxBytes,
             "Bytes that one such answer may have (default: 8G); more are refused, or the answer is cut");
    verb.add_option("--answer-threads", limits.points.threads, "Threads that work on one such answer")
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->group("Limits");
    verb.add_option(
            "--pictures-per-minute", limits.picturesPerMinute,
            "Pictures that are drawn for one client in a minute, on average; more: 429. 0: any number")
        ->check(CLI::Range(0.0, 1e6))
        ->capture_default_str()
        ->group("Limits");
    addBytes(verb, "--temp-bytes", limits.scratchBytes,
             "Bytes of all answers that are made as files (LAZ) and not sent yet (default: 16G); more: 503");
    verb.add_option("--temp", limits.scratchFolder,
                    "Folder for them (default: the system's for temporary files)")
        ->check(CLI::ExistingDirectory)
        ->group("Limits");
}

void addUpstreamOptions(CLI::App& verb, UpstreamOptions& upstream) {
    auto setFresh = [&upstream](double seconds) {
        upstream.freshFor = std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
    };
    auto setTimeout = [&upstream](double seconds) {
        upstream.answerTimeout = std::chrono::milliseconds(static_cast<std::int64_t>(seconds * 1000));
    };
    for (CLI::Option* option :
         {addBytes(verb, "--upstream-cache", upstream.cacheBytes,
                   "Bytes of memory for parts of clouds at other servers (default: 256M)"),
          verb.add_option_function<double>("--upstream-fresh", setFresh,
                                           "Seconds until a cloud at another server is looked at again")
              ->check(CLI::Range(0.0, 86400.0))
              ->default_str("10"),
          verb.add_option_function<double>("--upstream-seconds", setTimeout,
                                           "Seconds that another server may take to go on answering")
              ->check(CLI::Range(0.1, 3600.0))
              ->default_str("15"),
          verb.add_option("--upstream-ca", upstream.caPath,
                          "PEM file of the certificates that other servers' must rest on, instead of the "
                          "system's")
              ->check(CLI::ExistingFile),
          verb.add_option("--upstream-token-file", upstream.tokenPath,
                          "File of the bearer tokens that other servers want: an origin and its token a line "
                          "(https://bucket.example TOKEN); read again on SIGHUP"),
          verb.add_option("--upstream-disk", upstream.diskFolder,
                          "Folder of its own for parts of clouds at other servers, which are found there "
                          "again after a restart")})
        option->group("Clouds at other servers");
    addBytes(verb, "--upstream-disk-bytes", upstream.diskBytes, "Bytes of disk for them (default: 16G)")
        ->needs("--upstream-disk")
        ->group("Clouds at other servers");
}

} // namespace

void addSiteOptions(CLI::App& verb, ChosenSite& chosen) {
    addUpstreamOptions(verb, chosen.upstream);
    verb.add_option("--page", chosen.pageFolder, "Folder of the built page");
    verb.add_option("--access", chosen.accessFile,
                    "File that says which clouds are private and who may read them (see `stipple access`)");
    verb.add_option("--cors", chosen.origins,
                    "Origin whose pages may read all clouds, such as https://maps.example; may be given "
                    "several times; * for all. Public clouds are readable by every origin, unless the server "
                    "is for this machine alone (a loopback --host without --trust-proxy)")
        ->allow_extra_args(false)
        ->delimiter(',');
    CLI::Option* format = verb.add_option("--log", chosen.logFormat, "Log each request: combined, json")
                              ->check(CLI::IsMember({"combined", "json"}));
    verb.add_option("--log-file", chosen.logFile, "Append the log to this file, not to standard error")
        ->needs(format);
    addApiOptions(verb, chosen.api);
}

Result<SiteOptions> siteOptions(const ChosenSite& chosen, bool isForThisMachine) {
    SiteOptions options;
    if (!chosen.accessFile.empty()) {
        STIPPLE_TRY(access, AccessControl::open(chosen.accessFile));
        options.access = std::move(access);
    }
    STIPPLE_TRY(cors,
                CorsRules::listing(chosen.origins, isForThisMachine ? CorsRules::PublicFor::listedOrigins
                                                                    : CorsRules::PublicFor::everyOrigin));
    options.cors = std::move(cors);
    options.api = chosen.api;
    // A wrong name is told at the start, not when a cloud of another server is asked for.
    if (!chosen.upstream.tokenPath.empty())
        STIPPLE_CHECK(UpstreamTokens::load(chosen.upstream.tokenPath));
    return options;
}

Result<std::unique_ptr<AccessLog>> openLog(const ChosenSite& chosen) {
    if (chosen.logFormat.empty())
        return std::unique_ptr<AccessLog>();
    return AccessLog::open(chosen.logFormat == "json" ? LogFormat::json : LogFormat::combined,
                           chosen.logFile);
}

} // namespace stipple::server
