// What both ways of selecting (selection.cpp, continuous_selection.cpp) do with a node once it is chosen:
// whether it can be drawn, what has to be loaded, the counters.
#pragma once

#include "client/core/frustum.hpp"
#include "client/core/selection.hpp"

#include <vector>

namespace stipple {

class SelectionBuilder {
  public:
    explicit SelectionBuilder(const SelectionInput& input) : input_(input), frustum_(input.view) {}

    FrameCounters& counters() { return result_.counters; }
    // Outside, too, if clip boxes hide all of it. Counts it if it is outside. `parent`: the sight of a box
    // around the node's.
    Sight sightOf(const HierarchyNode& node, Sight parent);
    double pixelsOf(const NodeGeometry& geometry) const {
        return projectedPixels(input_.view, input_.height, geometry.centre, geometry.radius);
    }

    const Frustum& frustum() const { return frustum_; }

    // A node that belongs in the picture with its first `points` > 0 points. Best first; `ancestorsDrawn`:
    // all of them that hold points are here, or will never be. Returns whether its children may show.
    bool choose(std::uint32_t cloud, std::uint32_t node, double pixels, std::uint32_t points,
                bool ancestorsDrawn);

    // A node whose children are missing: their chunk is wanted if `sizeOf(geometry of a child in view)` is at
    // least `leastSize` for one of them; the larger, the sooner.
    template <class SizeOf>
    void wantChunk(std::uint32_t cloud, std::uint32_t node, double leastSize, const SizeOf& sizeOf) {
        const Hierarchy& hierarchy = *input_.clouds[cloud].hierarchy;
        const NodeEntry& entry = hierarchy.node(node).entry;
        double largest = -1;
        for (int c = 0; c < 8; ++c) {
            if (!((entry.childMask >> c) & 1))
                continue;
            NodeGeometry geometry = hierarchy.geometryOf(entry.key.child(c));
            if (mayShow(geometry.box) && !isClipped(geometry.box))
                largest = std::max(largest, sizeOf(geometry));
        }
        if (largest >= 0 && largest >= leastSize)
            addChunk({cloud, node, largest});
    }

    Selection finish();

  private:
    bool mayShow(const BoxD& box) const { return !input_.skips.unseen || frustum_.intersects(box); }
    bool isClipped(const BoxD& box) const {
        return input_.skips.clipped && input_.clips && input_.clips->clipVerdict(box).hidden;
    }
    void want(std::uint32_t cloud, std::uint32_t node, double pixels, std::uint32_t points,
              std::uint32_t here);
    void addChunk(const WantedChunk& chunk);

    const SelectionInput& input_;
    Frustum frustum_;
    std::vector<WantedNode> beginnings_;
    Selection result_;
};

} // namespace stipple
