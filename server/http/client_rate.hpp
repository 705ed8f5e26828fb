// How often each client may have something that is dear: a bucket of turns for each, which fills again
// evenly. Thread: any.
#pragma once

#include <chrono>
#include <cstddef>
#include <mutex>
#include <string>
#include <unordered_map>

namespace stipple::server {

class ClientRate {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t maxClients = 100'000; // kept; beyond them newcomers share one bucket

    // So many turns a minute for each client, which it may take all at once, but at least one at a time. 0:
    // any number.
    explicit ClientRate(double perMinute) : perMinute_(perMinute) {}

    // Takes a turn, and answers zero; or none is left, and answers how long to wait for the next one: whole
    // seconds, at least one.
    std::chrono::seconds take(const std::string& client, Clock::time_point now);

    double perMinute() const { return perMinute_; }
    std::size_t clients() const; // that are kept

  private:
    struct Bucket {
        double turns;
        Clock::time_point filledAt;
    };
    double most() const; // turns in a bucket
    double turnsAt(const Bucket& bucket, Clock::time_point now) const;
    Bucket& bucketOf(const std::string& client, Clock::time_point now);

    const double perMinute_;
    mutable std::mutex mutex_;
    std::unordered_map<std::string, Bucket> buckets_; // of clients whose buckets are not full
};

} // namespace stipple::server
