#include "client/core/transfer_estimate.hpp"

#include <algorithm>

namespace stipple {

namespace {

double secondsFrom(TransferEstimate::Time from, TransferEstimate::Time to) {
    return std::chrono::duration<double>(to - from).count();
}

// Clocks have their steps; what comes within one says nothing of the network.
constexpr double leastSeconds = 1e-4;

} // namespace

TransferEstimate::Sent TransferEstimate::sent(Time now, std::uint64_t partBytes) const {
    return {now, deliveredBytes_ + static_cast<double>(partBytes)};
}

void TransferEstimate::begun(const Sent& sent, Time now) {
    remember(delays_, std::max(0.0, secondsFrom(sent.at, now)));
}

void TransferEstimate::arrived(const Sent& sent, std::uint64_t bytes, Time now, std::uint64_t partBytes,
                               bool hasBegun) {
    double seconds = secondsFrom(sent.at, now);
    if (seconds < leastSeconds || bytes == 0)
        return;
    remember(rates_, (deliveredBytes_ + static_cast<double>(partBytes) - sent.deliveredBytes) / seconds);
    if (!hasBegun)
        remember(delays_, std::max(seconds / 2, seconds - static_cast<double>(bytes) / bytesPerSecond()));
}

double TransferEstimate::bytesPerSecond() const {
    return rates_.empty() ? 0 : *std::max_element(rates_.begin(), rates_.end());
}

double TransferEstimate::delaySeconds() const {
    return delays_.empty() ? 0 : *std::min_element(delays_.begin(), delays_.end());
}

void TransferEstimate::remember(std::deque<double>& samples, double sample) {
    samples.push_back(sample);
    if (samples.size() > remembered)
        samples.pop_front();
}

} // namespace stipple
