#include "client/core/load_limits.hpp"
#include "client/core/transfer_estimate.hpp"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace stipple;
using namespace std::chrono_literals;

namespace {

using Time = TransferEstimate::Time;

Time at(double seconds) {
    return Time{} + std::chrono::nanoseconds(static_cast<std::int64_t>(seconds * 1e9));
}

} // namespace

TEST_CASE("nothing is known before anything came") {
    TransferEstimate estimate;
    CHECK_FALSE(estimate.isKnown());
    CHECK(estimate.bytesPerSecond() == 0);
    LoadLimits most;
    LoadLimits limits = adaptedLimits(most, estimate);
    CHECK(limits.bytes == unmeasuredLimits(most).bytes);
    CHECK(limits.mergeGapBytes <= 4096);
}

TEST_CASE("requests that share a link tell its bandwidth together, and its delay by their first bytes") {
    TransferEstimate estimate;
    // Two requests of 500,000 bytes each over a megabyte a second, after 50 ms.
    auto first = estimate.sent(at(1), 0), second = estimate.sent(at(1), 0);
    estimate.begun(first, at(1.05));
    estimate.begun(second, at(1.05));
    estimate.delivered(1'000'000);
    estimate.arrived(first, 500'000, at(2.05), 0, true);
    estimate.arrived(second, 500'000, at(2.05), 0, true);
    CHECK(estimate.bytesPerSecond() == Approx(1e6 / 1.05));
    CHECK(estimate.delaySeconds() == Approx(0.05));
    // With something always on its way the delay no longer hides the bandwidth; what had come of it before
    // does not count.
    auto third = estimate.sent(at(3), 400'000);
    estimate.delivered(400'000 + 800'000);
    estimate.arrived(third, 800'000, at(4), 200'000, true);
    CHECK(estimate.bytesPerSecond() == Approx(1e6));
}

TEST_CASE("a network that has become slower is known to be so after some requests") {
    TransferEstimate estimate;
    double now = 0;
    for (double seconds : {0.1, 1.0})
        for (int i = 0; i < 20; ++i, now += 10 * seconds) { // pauses are no slowness
            auto sent = estimate.sent(at(now), 0);
            estimate.begun(sent, at(now + seconds / 10));
            estimate.delivered(100'000);
            estimate.arrived(sent, 100'000, at(now + seconds), 0, true);
        }
    CHECK(estimate.bytesPerSecond() == Approx(1e5));
    CHECK(estimate.delaySeconds() == Approx(0.1));
}

TEST_CASE("a source that can't tell how far it is has the delay that is left of its answers") {
    TransferEstimate estimate;
    auto large = estimate.sent(at(0), 0);
    estimate.delivered(1'000'000);
    estimate.arrived(large, 1'000'000, at(1), 0, false);
    CHECK(estimate.delaySeconds() == Approx(0.5)); // who knows
    auto small = estimate.sent(at(1), 0);
    estimate.delivered(1000);
    estimate.arrived(small, 1000, at(1.2), 0, false);
    CHECK(estimate.delaySeconds() == Approx(0.199));
}

TEST_CASE("answers without a time between tell nothing") {
    TransferEstimate estimate;
    estimate.delivered(1000);
    estimate.arrived(estimate.sent(at(5), 0), 1000, at(5), 0, false);
    CHECK_FALSE(estimate.isKnown());
}

TEST_CASE("limits follow bandwidth and delay, within those that are given") {
    bool isFirm = true;
    auto fitted = [&](double bytesPerSecond, double delay,
                      LoadLimits most = {6, 32 << 20, 256 << 10, 4 << 20}) {
        TransferEstimate estimate;
        for (int i = 0; i < (isFirm ? 10 : 1); ++i) {
            auto sent = estimate.sent(at(i), 0);
            auto bytes = static_cast<std::uint64_t>(bytesPerSecond);
            estimate.begun(sent, at(i + delay));
            estimate.delivered(bytes);
            estimate.arrived(sent, bytes, at(i + 1), 0, true);
        }
        return adaptedLimits(most, estimate);
    };
    LoadLimits slow = fitted(625'000, 0.005); // 5 Mbit/s
    CHECK(slow.bytes == 192 << 10);
    CHECK(slow.mergedRequestBytes == 32 << 10);
    CHECK(slow.mergeGapBytes == 4096);
    CHECK(slow.pieceBytes == 16 << 10);
    LoadLimits wide = fitted(62.5e6, 0.2); // 500 Mbit/s
    CHECK(wide.bytes == 32 << 20);
    CHECK(static_cast<double>(wide.bytes) > 62.5e6 * 0.2); // the pipe is full
    CHECK(wide.mergedRequestBytes == 4 << 20);
    CHECK(wide.mergeGapBytes == 256 << 10);
    LoadLimits tight = fitted(62.5e6, 0.2, {2, 100'000, 10, 2000});
    CHECK(tight.requests == 2);
    CHECK(tight.bytes == 100'000);
    CHECK(tight.mergeGapBytes == 10);
    CHECK(tight.mergedRequestBytes == 2000);
    // One sample, of a delay that may hide any bandwidth: as of 16 Mbit/s.
    LoadLimits known = fitted(2e6, 0.2);
    auto apart = [](std::uint64_t a, std::uint64_t b) { return std::max(a, b) - std::min(a, b); };
    CHECK(apart(known.bytes, 1'200'000) <= 1); // rounded down
    isFirm = false;
    LoadLimits hoped = fitted(300'000, 0.2);
    CHECK(apart(hoped.bytes, known.bytes) <= 1);
    CHECK(apart(hoped.mergeGapBytes, known.mergeGapBytes) <= 1);
    CHECK(hoped.mergeGapBytes > 4096);
    CHECK(apart(hoped.pieceBytes, known.pieceBytes) <= 1);
}
