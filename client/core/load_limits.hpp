// How much may be on its way, and how large a request is: fixed, or fitted to the network that was measured.
#pragma once

#include "client/core/transfer_estimate.hpp"

#include <cstdint>

namespace stipple {

struct LoadLimits {
    int requests = 6;
    std::uint64_t bytes = 8ull << 20;
    std::uint64_t mergeGapBytes = 4096;
    std::uint64_t mergedRequestBytes = 1ull << 20;
    bool mergesNodes = true; // false: only parts of one node travel together
    // A node is asked for in pieces of at least so many bytes (whole strata), so that coarse strata of all
    // nodes come before fine ones of some; a piece costs a round trip.
    std::uint64_t pieceBytes = ~std::uint64_t{0};
    // A request that nothing needs any more is let finish if no more than this, or than half of it, is
    // missing.
    std::uint64_t letFinishBytes = 16 << 10;
    bool letsUnbegunFinish = false; // also one of which nothing has come yet
    std::uint64_t pipeBytes = 0;    // what the network holds, as far as is known; 0: it isn't
};

// Before anything was measured, and where a source answers at once: `most`, but no more than what is safe on
// any network.
LoadLimits unmeasuredLimits(const LoadLimits& most);

// Fitted to the network, within `most`. With bandwidth B, delay d and the product B d (what the network
// holds):
//
// * bytes, 2 B (d + 0.1 s): the pipe is full, also while the next is being chosen, and what is on its way is
//   at most 0.2 s + 2 d old when it comes, so that a new view is soon served
// * mergedRequestBytes, that over all connections
// * mergeGapBytes, B d / requests / 4: half of what a connection could carry while a request of its own
//   travels
// * pieceBytes, 2 B d / requests: so much that a connection is busy for two thirds of the time
// * letFinishBytes, 3 B d, begun or not: what would come in the time in which a new connection is made and
//   asked. A camera that moves faster than answers come would never see one if all were cancelled; what is
//   let finish is coarse at first, and of use elsewhere (flight_bench, docs/MEASUREMENTS.md)
//
// What was measured is the network's bandwidth only if enough was on its way to fill it. While little was
// measured, and where requests come back about as soon as the delay allows (`isPipeShort`), it is taken to be
// at least 16 Mbit/s: then larger requests, with gaps between, cost less than further round trips.
LoadLimits adaptedLimits(const LoadLimits& most, const TransferEstimate& estimate, bool isPipeShort = false);

} // namespace stipple
