// Ending a server by signals, in two steps, and having it read again what may have changed.
#pragma once

#include "server/net/server.hpp"

#include <chrono>
#include <functional>
#include <memory>

namespace stipple::server {

// Catches SIGINT, SIGTERM and SIGHUP from its construction on. Made before the server listens: a signal that
// comes right after the address was printed must be seen, and clients that take every descriptor must not
// keep this from getting its own.
class ServerSignals {
  public:
    ServerSignals();
    ~ServerSignals();

    // Blocks until the server has ended. SIGHUP calls `reload`, on this thread, if there is one, and is like
    // the others if not. The first of those announces the end for `notice`, then stops accepting and lets
    // running answers finish for up to `grace`; a second one, or the end of that time, cuts what is left.
    void runUntilSignalled(Server& server, std::chrono::milliseconds notice, std::chrono::milliseconds grace,
                           const std::function<void()>& reload);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace stipple::server
