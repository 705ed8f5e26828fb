// A cloud at another server: which version is current, looked at now and then. Thread: any.
#pragma once

#include "server/site/cloud_version.hpp"
#include "server/upstream/upstream.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace stipple::server {

class UpstreamCloud {
  public:
    // Asks for nothing yet. Errors: what parseHttpUrl says of the address.
    static Result<std::shared_ptr<UpstreamCloud>> open(std::shared_ptr<Upstream> upstream, std::string url);

    // Whether it is time to look again: then prepare() comes before current().
    bool mustBePrepared() const;
    // Looks at the upstream, one caller at a time while the others wait for what it finds.
    void prepare(const std::atomic<bool>& stop);
    // The version that was found last; doesn't wait. While the upstream can't be reached it stays, and what
    // is held of it is answered. Errors: as UpstreamVersion::find and readCloud; `cancelled` before the
    // first prepare().
    Result<std::shared_ptr<const CloudVersion>> current() const;

  private:
    using Clock = std::chrono::steady_clock;
    UpstreamCloud(std::shared_ptr<Upstream> upstream, std::string url)
        : upstream_(std::move(upstream)), url_(std::move(url)) {}
    Result<std::shared_ptr<const CloudVersion>> look(const std::atomic<bool>& stop) const;
    bool takeTurn(const std::atomic<bool>& stop);
    void giveTurn();
    bool mustLookLocked() const;

    const std::shared_ptr<Upstream> upstream_;
    const std::string url_;
    mutable std::mutex mutex_; // of what follows
    std::condition_variable lookOver_;
    bool isLooking_ = false; // somebody is
    std::shared_ptr<const CloudVersion> version_;
    std::optional<Error> failure_; // of the last look
    std::optional<Clock::time_point> lookedAt_;
};

} // namespace stipple::server
