#include "client/core/rank_density.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

RankDensity rankDensity(int level, double spacing, std::uint32_t points) {
    double square = spacing * spacing, count = std::max(1u, points);
    if (level == 0)
        return {0.5 / (count * square), 1 / (count * square)};
    return {(1 + 1.5 / count) / (4 * square), 3 / (4 * count * square)};
}

RankDensity leafDensity(const RankDensity& asOfAnyNode, const RankDensity& parent, int siblings) {
    // parent.step is 1 over the area that the parent's points fill, in units of a point's.
    return {asOfAnyNode.base, std::max(asOfAnyNode.step, siblings * parent.step)};
}

double rankLevel(const RankDensity& density, double rootSpacing, std::uint32_t rank) {
    return std::log2(rootSpacing) + std::log2(density.base + density.step * rank) / 2;
}

} // namespace stipple
