// How many connections are open, in all and of each client. Thread: any. Internal to server/net.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

namespace stipple::server {

class ConnectionCount {
  public:
    // False, and nothing is counted, if the group has `limit` already.
    bool add(const std::string& group, int limit);
    void remove(const std::string& group);
    int all() const;
    std::uint64_t refused() const; // times that add() said no

    // No connection will be added any more.
    void close();
    // True once closed and none is left; waits up to `limit` for that.
    bool waitUntilNone(std::chrono::milliseconds limit);

  private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::unordered_map<std::string, int> ofGroup_; // without zeros
    int all_ = 0;
    std::uint64_t refused_ = 0;
    bool isClosed_ = false;
};

} // namespace stipple::server
