#include "client/core/load_limits.hpp"

#include <algorithm>

namespace stipple {

namespace {

constexpr double chosenAheadSeconds = 0.1, hopedBytesPerSecond = 2e6;
constexpr std::uint64_t leastBytesInFlight = 192 << 10, leastGapBytes = 4096, leastRequestBytes = 32 << 10;
constexpr std::uint64_t leastLetFinishBytes = 16 << 10, leastPieceBytes = 16 << 10;

std::uint64_t within(double value, std::uint64_t least, std::uint64_t most) {
    if (value >= static_cast<double>(most))
        return most;
    return std::clamp(static_cast<std::uint64_t>(std::max(value, 0.0)), std::min(least, most), most);
}

} // namespace

LoadLimits unmeasuredLimits(const LoadLimits& most) {
    LoadLimits safe = most;
    safe.bytes = std::min<std::uint64_t>(most.bytes, 8 << 20);
    safe.mergeGapBytes = std::min<std::uint64_t>(most.mergeGapBytes, leastGapBytes);
    safe.mergedRequestBytes = std::min<std::uint64_t>(most.mergedRequestBytes, 1 << 20);
    return safe;
}

LoadLimits adaptedLimits(const LoadLimits& most, const TransferEstimate& estimate, bool isPipeShort) {
    if (!estimate.isKnown())
        return unmeasuredLimits(most);
    double rate = estimate.bytesPerSecond(), delay = estimate.delaySeconds();
    std::uint64_t pipeBytes = within(rate * delay, 1, most.bytes);
    if (isPipeShort || !estimate.isFirm())
        rate = std::max(rate, hopedBytesPerSecond);
    double held = rate * delay, requests = std::max(1, most.requests);
    LoadLimits fitted = most;
    fitted.pipeBytes = pipeBytes;
    fitted.bytes = within(2 * rate * (delay + chosenAheadSeconds), leastBytesInFlight, most.bytes);
    fitted.mergedRequestBytes =
        within(static_cast<double>(fitted.bytes) / requests, leastRequestBytes, most.mergedRequestBytes);
    fitted.mergeGapBytes = within(held / requests / 4, leastGapBytes, most.mergeGapBytes);
    fitted.pieceBytes = within(2 * held / requests, leastPieceBytes, most.mergedRequestBytes);
    fitted.letsUnbegunFinish = true;
    fitted.letFinishBytes = within(3 * held, leastLetFinishBytes, most.bytes);
    return fitted;
}

} // namespace stipple
