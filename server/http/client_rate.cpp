#include "server/http/client_rate.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::server {

double ClientRate::most() const {
    return std::max(1.0, perMinute_);
}

double ClientRate::turnsAt(const Bucket& bucket, Clock::time_point now) const {
    double minutes = std::chrono::duration<double, std::ratio<60>>(now - bucket.filledAt).count();
    return std::min(most(), bucket.turns + std::max(0.0, minutes) * perMinute_);
}

// A full bucket is as good as none, so those are forgotten when there are too many.
ClientRate::Bucket& ClientRate::bucketOf(const std::string& client, Clock::time_point now) {
    auto found = buckets_.find(client);
    if (found != buckets_.end())
        return found->second;
    if (buckets_.size() >= maxClients)
        std::erase_if(buckets_, [&](const auto& entry) { return turnsAt(entry.second, now) >= most(); });
    const std::string& name = buckets_.size() >= maxClients ? std::string() : client;
    return buckets_.try_emplace(name, Bucket{most(), now}).first->second;
}

std::chrono::seconds ClientRate::take(const std::string& client, Clock::time_point now) {
    if (!(perMinute_ > 0))
        return std::chrono::seconds(0);
    std::lock_guard lock(mutex_);
    Bucket& bucket = bucketOf(client, now);
    bucket = {turnsAt(bucket, now), now};
    if (bucket.turns >= 1) {
        bucket.turns -= 1;
        return std::chrono::seconds(0);
    }
    double seconds = (1 - bucket.turns) / perMinute_ * 60;
    return std::chrono::seconds(std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(seconds))));
}

std::size_t ClientRate::clients() const {
    std::lock_guard lock(mutex_);
    return buckets_.size();
}

} // namespace stipple::server
