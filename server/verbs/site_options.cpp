#include "server/verbs/site_options.hpp"

namespace stipple::server {

void addSiteOptions(CLI::App& verb, ChosenSite& chosen) {
    verb.add_option("--page", chosen.pageFolder, "Folder of the built page");
    verb.add_option("--access", chosen.accessFile,
                    "File that says which clouds are private and who may read them (see `stipple access`)");
    verb.add_option("--cors", chosen.origins,
                    "Origin whose pages may read private clouds, such as https://maps.example; may be given "
                    "several times; * for all. Public clouds are readable by every origin")
        ->allow_extra_args(false)
        ->delimiter(',');
    CLI::Option* format = verb.add_option("--log", chosen.logFormat, "Log each request: combined, json")
                              ->check(CLI::IsMember({"combined", "json"}));
    verb.add_option("--log-file", chosen.logFile, "Append the log to this file, not to standard error")
        ->needs(format);
}

Result<SiteOptions> siteOptions(const ChosenSite& chosen) {
    SiteOptions options;
    if (!chosen.accessFile.empty()) {
        STIPPLE_TRY(access, AccessControl::open(chosen.accessFile));
        options.access = std::move(access);
    }
    STIPPLE_TRY(cors, CorsRules::listing(chosen.origins));
    options.cors = std::move(cors);
    return options;
}

Result<std::unique_ptr<AccessLog>> openLog(const ChosenSite& chosen) {
    if (chosen.logFormat.empty())
        return std::unique_ptr<AccessLog>();
    return AccessLog::open(chosen.logFormat == "json" ? LogFormat::json : LogFormat::combined,
                           chosen.logFile);
}

} // namespace stipple::server
