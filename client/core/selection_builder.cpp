#include "client/core/selection_builder.hpp"

#include <algorithm>

namespace stipple {

namespace {

// A node whose radius spans this part of the picture's height is coarse: its first stratum alone is fetched
// first, ahead of everything finer, so that the whole view fills early. Finer nodes come in one piece, since
// a request of their own for each stratum would cost more round trips than it saves bytes.
constexpr double coarseHeights = 0.5;

} // namespace

Sight SelectionBuilder::sightOf(const HierarchyNode& node, Sight parent) {
    Sight sight = parent;
    if (parent != Sight::inside) {
        sight = frustum_.sightOf(node.geometry.box);
        if (sight == Sight::outside && !input_.skips.unseen)
            sight = Sight::crossing;
        counters().nodesOutsideFrustum += sight == Sight::outside;
    }
    bool clipped = sight != Sight::outside && isClipped(node.geometry.box);
    counters().nodesClipped += clipped;
    return clipped ? Sight::outside : sight;
}

bool SelectionBuilder::choose(std::uint32_t cloud, std::uint32_t node, double pixels, std::uint32_t points,
                              bool ancestorsDrawn) {
    const NodeResidency& residency = input_.clouds[cloud].residency[node];
    if (!input_.skips.tooFine)
        points = input_.clouds[cloud].hierarchy->node(node).entry.pointCount;
    SelectedNode selected{cloud, node, pixels, points, 0};
    std::uint32_t here = std::min(points, residency.points);
    if (ancestorsDrawn)
        selected.drawPoints = here;
    ++counters().nodesSelected;
    counters().pointsSelected += points;
    counters().pointsDrawn += selected.drawPoints;
    counters().nodesDrawn += selected.drawPoints > 0;
    if (here < points && !residency.failed) {
        ++counters().nodesWaiting;
        want(cloud, node, pixels, points, residency.points);
    }
    result_.nodes.push_back(selected);
    return ancestorsDrawn && (here > 0 || residency.failed);
}

void SelectionBuilder::want(std::uint32_t cloud, std::uint32_t node, double pixels, std::uint32_t points,
                            std::uint32_t here) {
    int strata = strataFor(input_.clouds[cloud].hierarchy->node(node).entry.pointCount, points);
    bool firstStratumOnly = input_.beginningsFirst && here == 0 && pixels >= coarseHeights * input_.height;
    if (input_.wholeNodes)
        result_.loads.push_back({cloud, node, strataCount});
    else if (firstStratumOnly)
        beginnings_.push_back({cloud, node, 1});
    else
        result_.loads.push_back({cloud, node, strata});
}

void SelectionBuilder::addChunk(const WantedChunk& chunk) {
    ++counters().chunksWaiting;
    result_.chunks.push_back(chunk);
}

Selection SelectionBuilder::finish() {
    result_.loads.insert(result_.loads.begin(), beginnings_.begin(), beginnings_.end());
    std::stable_sort(result_.chunks.begin(), result_.chunks.end(),
                     [](const WantedChunk& a, const WantedChunk& b) { return a.pixels > b.pixels; });
    counters().complete = counters().nodesWaiting == 0 && counters().chunksWaiting == 0;
    return std::move(result_);
}

} // namespace stipple
