// Options of `serve` and `view` that concern what is served and to whom: the page, rights, origins, the log.
#pragma once

#include "server/log/access_log.hpp"
#include "server/site/site.hpp"
#include "shared/cli/verb.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stipple::server {

struct ChosenSite {
    std::string pageFolder; // empty: the built page beside the program or in the source tree
    std::string accessFile; // empty: every cloud is public
    std::vector<std::string> origins;
    ApiLimits api;
    UpstreamOptions upstream;       // of clouds at other servers
    std::string logFormat, logFile; // format empty: no log; file empty: standard error
};

void addSiteOptions(CLI::App& verb, ChosenSite& chosen);

// `isForThisMachine`: other clients don't reach the server. Errors: those of the access file; invalidArgument
// for an origin that is none.
Result<SiteOptions> siteOptions(const ChosenSite& chosen, bool isForThisMachine);

// Null if none was asked for. Errors: writeFailed.
Result<std::unique_ptr<AccessLog>> openLog(const ChosenSite& chosen);

} // namespace stipple::server
