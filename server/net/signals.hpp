// Ending a server by signals, in two steps.
#pragma once

#include "server/net/server.hpp"

#include <chrono>

namespace stipple::server {

// Blocks until the server has ended. The first SIGINT or SIGTERM stops accepting and lets running answers
// finish for up to `grace`; a second one, or the end of that time, cuts what is left.
void runUntilSignalled(Server& server, std::chrono::milliseconds grace);

} // namespace stipple::server
