// What `serve` and `view` share: options, start, the line that says where, and the end.
#pragma once

#include "server/net/server.hpp"
#include "server/verbs/site_options.hpp"
#include "shared/base/result.hpp"
#include "shared/cli/verb.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stipple::server {

struct ServingOptions {
    ServerOptions server; // its port is 8017 unless chosen otherwise
    ChosenSite site;
    bool asJson = false;
    int noticeSeconds = 0, graceSeconds = 10; // at the end
    bool reloadsOnHangUp =
        false; // SIGHUP, as services have it; otherwise it ends, as a closed terminal should
};

void addServingOptions(CLI::App& verb, ServingOptions& options);

// Serves the clouds of `paths` until a signal ends it; `verb` is for messages. Prints one line to standard
// output once it listens, then calls `onReady` with the address. Returns the exit code.
int serveUntilSignalled(const char* verb, const ServingOptions& options,
                        const std::vector<std::string>& paths,
                        const std::function<void(const std::string& address)>& onReady);

} // namespace stipple::server
