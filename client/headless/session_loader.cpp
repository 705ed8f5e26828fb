#include "client/headless/session_loader.hpp"

#include "shared/base/text.hpp"

#include <utility>

namespace stipple::headless {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::milliseconds updateWait{20}; // until looking whether it was stopped

} // namespace

SessionLoader::SessionLoader(ViewSession& session, std::string name, std::chrono::milliseconds timeout,
                             const std::atomic<bool>* stop)
    : session_(session), name_(std::move(name)), timeout_(timeout), deadline_(Clock::now() + timeout),
      stop_(stop) {}

Status SessionLoader::until(const std::function<bool()>& done) {
    while (!done()) {
        if (stop_ && *stop_)
            return Error{ErrorCode::cancelled, "the picture was taken back", name_, ""};
        if (Clock::now() >= deadline_)
            return timeOut();
        session_.update(updateWait);
        for (const CloudState& cloud : session_.clouds())
            if (cloud.stage == CloudStage::failed)
                return cloud.error;
    }
    std::vector<Error> errors = session_.recentErrors();
    return errors.empty() ? Status() : Status(errors.front());
}

// What keeps failing says more than that it took too long.
Status SessionLoader::timeOut() const {
    if (std::optional<Error> failure = session_.passingFailure())
        return *failure;
    bool address = name_.find("://") != std::string::npos;
    return Error{address ? ErrorCode::networkFailed : ErrorCode::limitExceeded,
                 cat("not everything that the picture needs has arrived within ",
                     static_cast<double>(timeout_.count()) * 1e-3, " s"),
                 name_, "lower --budget or raise --timeout"};
}

} // namespace stipple::headless
