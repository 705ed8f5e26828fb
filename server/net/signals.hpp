// Ending a server by signals, in two steps.
#pragma once

#include "server/net/server.hpp"

#include <chrono>
#include <memory>

namespace stipple::server {

// Catches SIGINT and SIGTERM from its construction on. Made before the server listens: a signal that comes
// right after the address was printed must be seen, and clients that take every descriptor must not keep this
// from getting its own.
class StopSignals {
  public:
    StopSignals();
    ~StopSignals();

    // Blocks until the server has ended. The first signal stops accepting and lets running answers finish for
    // up to `grace`; a second one, or the end of that time, cuts what is left.
    void runUntilSignalled(Server& server, std::chrono::milliseconds grace);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace stipple::server
