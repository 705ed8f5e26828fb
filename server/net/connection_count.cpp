#include "server/net/connection_count.hpp"

namespace stipple::server {

bool ConnectionCount::add(const std::string& group, int limit) {
    std::lock_guard lock(mutex_);
    int& count = ofGroup_[group];
    if (count >= limit) {
        ++refused_;
        if (count == 0)
            ofGroup_.erase(group);
        return false;
    }
    ++count;
    ++all_;
    return true;
}

void ConnectionCount::remove(const std::string& group) {
    std::lock_guard lock(mutex_);
    auto found = ofGroup_.find(group);
    if (--found->second == 0)
        ofGroup_.erase(found);
    --all_;
    changed_.notify_all();
}

int ConnectionCount::all() const {
    std::lock_guard lock(mutex_);
    return all_;
}

std::uint64_t ConnectionCount::refused() const {
    std::lock_guard lock(mutex_);
    return refused_;
}

void ConnectionCount::close() {
    std::lock_guard lock(mutex_);
    isClosed_ = true;
    changed_.notify_all();
}

bool ConnectionCount::waitUntilNone(std::chrono::milliseconds limit) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, limit, [this] { return isClosed_ && all_ == 0; });
}

} // namespace stipple::server
