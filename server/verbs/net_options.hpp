// Options of `serve` and `view` that concern sockets: where to listen, TLS, limits.
#pragma once

#include "server/net/server.hpp"
#include "shared/cli/verb.hpp"

namespace stipple::server {

void addNetOptions(CLI::App& verb, ServerOptions& options);

} // namespace stipple::server
