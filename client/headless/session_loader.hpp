// Waits for what a session loads, up to a deadline.
#pragma once

#include "client/core/view_session.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

namespace stipple::headless {

class SessionLoader {
  public:
    // `session` has clouds of one source, called `name`; `timeout` counts from here on. `stop` (may be null)
    // outlives it.
    SessionLoader(ViewSession& session, std::string name, std::chrono::milliseconds timeout,
                  const std::atomic<bool>* stop = nullptr);

    // Updates the session until `done()`. Errors: of a cloud that failed, of single nodes (also once done: a
    // picture with holes is no answer); when time runs out, what failed last
    // and would be tried again, else networkFailed (addresses) or limitExceeded (files); cancelled once
    // `stop`.
    Status until(const std::function<bool()>& done);

  private:
    Status timeOut() const;

    ViewSession& session_;
    std::string name_;
    std::chrono::milliseconds timeout_;
    std::chrono::steady_clock::time_point deadline_;
    const std::atomic<bool>* stop_;
};

} // namespace stipple::headless
