// How dense a node's points lie by their rank in it, for continuous detail (continuous_detail.hpp has the
// derivation).
#pragma once

#include <cstdint>

namespace stipple {

// 1 / spacing² of a node's points: base + step × rank. World units^-2.
struct RankDensity {
    double base = 0, step = 0;
};
// `spacing` > 0, `points` > 0: of the whole node.
RankDensity rankDensity(int level, double spacing, std::uint32_t points);

// Of a leaf. It holds whatever its ancestors left, so its points may lie nearer to each other than its
// spacing says, and then each of them adds more to the density than its share of a level. What each adds
// follows from the surface below the parent, which the parent's own points fill to its spacing: a
// `siblings`-th of it is the leaf's.
RankDensity leafDensity(const RankDensity& asOfAnyNode, const RankDensity& parent, int siblings);

// The level that the point of a rank is of, by its spacing: log2(rootSpacing / spacing). Negative for all of
// the root's.
double rankLevel(const RankDensity& density, double rootSpacing, std::uint32_t rank);

} // namespace stipple
