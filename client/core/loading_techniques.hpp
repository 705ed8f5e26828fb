// What loading does to show more for each byte and sooner. On for everybody; each can be switched off to
// measure what it brings (tests/bench/streaming_bench.cpp).
#pragma once

namespace stipple {

struct LoadingTechniques {
    bool prefixes = true; // of a node only the strata that the picture needs
    bool merging = true;  // nodes that are neighbours in the file travel together
    bool byValue = true;  // what adds most to the picture for its bytes first, in pieces
    bool adaptive = true; // limits are fitted to the network
    friend bool operator==(const LoadingTechniques&, const LoadingTechniques&) = default;
};

} // namespace stipple
