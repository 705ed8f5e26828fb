// What requests tell of the network: its bandwidth and its delay, after BBR (Cardwell et al. 2016, "BBR:
// Congestion-Based Congestion Control"): the bandwidth is the most that was lately delivered in the time that
// a request took, the delay the least that lately passed between a request and the first of its bytes.
//
// As long as less is on its way than the network holds, what is delivered is too little; but who then asks
// for more than was delivered finds the limit in a few round trips.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>

namespace stipple {

class TransferEstimate {
  public:
    using Time = std::chrono::steady_clock::time_point;

    // What is to be kept with a request.
    struct Sent {
        Time at;
        double deliveredBytes = 0; // by then, of all requests
    };
    // `partBytes`, here and below: what has come of the requests that are on their way, as far as is known.
    Sent sent(Time now, std::uint64_t partBytes) const;
    // The first bytes of an answer were seen. (Sources that can't tell never say so; the answer's bytes at
    // the present bandwidth, but at most half of its time, then count as their way.)
    void begun(const Sent& sent, Time now);
    // Answers came: first all their bytes are told, then each of them.
    void delivered(std::uint64_t bytes) { deliveredBytes_ += static_cast<double>(bytes); }
    void arrived(const Sent& sent, std::uint64_t bytes, Time now, std::uint64_t partBytes, bool hasBegun);

    bool isKnown() const { return !rates_.empty(); }
    bool isFirm() const { return rates_.size() >= remembered / 2; }
    double bytesPerSecond() const; // > 0 once known
    double delaySeconds() const;

  private:
    static constexpr std::size_t remembered = 16; // samples
    static void remember(std::deque<double>& samples, double sample);

    double deliveredBytes_ = 0;
    std::deque<double> rates_, delays_;
};

} // namespace stipple
