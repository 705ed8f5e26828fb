#include "server/upstream/upstream_cloud.hpp"

#include "client/headless/http_url.hpp"
#include "server/upstream/upstream_version.hpp"

namespace stipple::server {

namespace {

Result<std::shared_ptr<const CloudVersion>> readVersion(std::shared_ptr<UpstreamVersion> upstream,
                                                        const std::string& url) {
    CloudVersion version;
    version.validators = {upstream->entityTag(), upstream->modifiedSeconds()};
    version.openSource = [upstream] { return upstream->openSource(); };
    version.upstream = std::move(upstream);
    return readCloud(std::move(version), url);
}

// Whether the upstream can't be asked, which says nothing of the version that it has.
bool isOutOfReach(const Error& error) {
    return error.code == ErrorCode::networkFailed || error.code == ErrorCode::accessDenied ||
           error.code == ErrorCode::cancelled;
}

} // namespace

Result<std::shared_ptr<UpstreamCloud>> UpstreamCloud::open(std::shared_ptr<Upstream> upstream,
                                                           std::string url) {
    if (auto parts = parseHttpUrl(url); !parts)
        return parts.error();
    return std::shared_ptr<UpstreamCloud>(new UpstreamCloud(std::move(upstream), std::move(url)));
}

bool UpstreamCloud::mustBePrepared() const {
    std::lock_guard lock(mutex_);
    return mustLookLocked();
}

bool UpstreamCloud::mustLookLocked() const {
    if (!lookedAt_)
        return true;
    auto age = Clock::now() - *lookedAt_;
    if (failure_)
        return age >= upstream_->options.retryPause;
    return version_->upstream->isGone() || age >= upstream_->options.freshFor;
}

// True: the caller looks, and gives its turn back. False: there is nothing to do any more. (No timed_mutex:
// the thread sanitizer of GCC 12 does not know how glibc waits for one.)
bool UpstreamCloud::takeTurn(const std::atomic<bool>& stop) {
    constexpr std::chrono::milliseconds untilLookingAtStop{20};
    std::unique_lock lock(mutex_);
    while (isLooking_ && !stop)
        lookOver_.wait_for(lock, untilLookingAtStop);
    if (isLooking_ || !mustLookLocked())
        return false;
    isLooking_ = true;
    return true;
}

void UpstreamCloud::giveTurn() {
    std::lock_guard lock(mutex_);
    isLooking_ = false;
    lookOver_.notify_all();
}

void UpstreamCloud::prepare(const std::atomic<bool>& stop) {
    if (!takeTurn(stop))
        return;
    struct Turn { // also by an exception
        UpstreamCloud& cloud;
        ~Turn() { cloud.giveTurn(); }
    } turn{*this};
    auto found = look(stop);
    if (!found && found.error().code == ErrorCode::cancelled)
        return; // whoever is next looks
    std::lock_guard lock(mutex_);
    lookedAt_ = Clock::now();
    failure_.reset();
    if (found)
        version_ = *found;
    else
        failure_ = found.error();
    if (!found && !isOutOfReach(found.error()))
        version_ = nullptr;
}

// The known version if the upstream still has it, else the one that it has.
Result<std::shared_ptr<const CloudVersion>> UpstreamCloud::look(const std::atomic<bool>& stop) const {
    std::shared_ptr<const CloudVersion> known;
    {
        std::lock_guard lock(mutex_);
        known = version_;
    }
    if (known && !known->upstream->isGone()) {
        Status status = known->upstream->check(stop);
        if (status)
            return known;
        if (isOutOfReach(status.error()))
            return status.error();
    }
    STIPPLE_TRY(found, UpstreamVersion::find(upstream_, url_, stop));
    return readVersion(found, url_);
}

Result<std::shared_ptr<const CloudVersion>> UpstreamCloud::current() const {
    std::lock_guard lock(mutex_);
    if (version_)
        return version_;
    if (failure_)
        return *failure_;
    return Error{ErrorCode::cancelled, "nobody has looked at the server that the cloud comes from", "", ""};
}

} // namespace stipple::server
