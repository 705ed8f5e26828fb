// Which nodes belong in the picture, which of them can be drawn now, and what has to be loaded: one pure
// function of view, hierarchies, residency and limits.
//
// Best first by projected size (times PriorityWeights), over all clouds together, a node before its children.
// It stops at the point budget (the last node draws a prefix), at the bytes of the cache and at the smallest
// useful size. What is selected does not depend on what is here, so loading never changes the aim.
//
// Levels add up: a node's points are those its level adds, and it is drawn together with all its ancestors. A
// node that is not here is stood in for by them; its descendants wait for it, since they would show
// their region finer than its surroundings and leave a hole where they end.
//
// Equal sizes are taken by cloud, then level, then key: same input, same selection.
//
// With continuous detail a node's prefix is what can show at the target spacing, best first means coarsest on
// the screen first, and where that is more than a budget allows, the target grows, for all nodes alike, until
// it is not: density stays even, no node is cut off. FrameCounters::detailPixels is the target then in force.
// The point budget there is of points that are likely to show; up to four times as many may be sent to the
// rasterizer.
#pragma once

#include "client/core/clips.hpp"
#include "client/core/counters.hpp"
#include "client/core/frame_plan.hpp"
#include "client/core/hierarchy.hpp"
#include "client/core/priority_weights.hpp"
#include "client/core/skips.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stipple {

struct NodeResidency {
    std::uint32_t points = 0; // prefix that can be drawn now
    bool failed = false;      // no more will come; its descendants need not wait for it
};

struct SelectionCloud {
    const Hierarchy* hierarchy = nullptr;     // null or without nodes: nothing to select
    std::span<const NodeResidency> residency; // parallel to the hierarchy's nodes
    std::uint32_t bytesPerPoint = 12;         // of a resident node
};

struct SelectionInput {
    ViewTransform view;
    int height = 0; // pixels
    std::span<const SelectionCloud> clouds;
    std::uint64_t pointBudget = 0;
    std::uint64_t byteBudget = 0;
    const Clips* clips = nullptr; // null: nothing is clipped away
    double minNodePixels = 0;     // discrete detail; the root of a cloud is wanted at any size
    PriorityWeights weights;      // discrete detail
    double detailPixels =
        0; // continuous detail with this target spacing (continuous_detail.hpp); 0: discrete
    Skips skips;
    bool wholeNodes = false; // nodes are wanted with all their strata, whatever the picture needs of them
    // Of coarse nodes the first stratum alone is wanted at first, ahead of everything. Off: whoever asks for
    // the loads brings them in an order of his own.
    bool beginningsFirst = true;
};

struct SelectedNode {
    std::uint32_t cloud = 0, node = 0; // indices of input.clouds and its hierarchy
    double pixels = 0;                 // projected radius
    std::uint32_t points = 0;          // prefix that belongs in the picture
    std::uint32_t drawPoints = 0;      // prefix to draw now: 0 if it, or an ancestor, is not here
};

struct WantedNode {
    std::uint32_t cloud = 0, node = 0;
    int strata = 0; // 1..4: so many are needed
};

struct WantedChunk {
    std::uint32_t cloud = 0, node = 0; // the node whose children are in the chunk
    double pixels = 0;                 // of the largest child that is in view
};

struct Selection {
    std::vector<SelectedNode> nodes; // best first
    std::vector<WantedNode> loads;   // most urgent first
    std::vector<WantedChunk> chunks; // most urgent first
    // All but the fields of the renderer. `complete`: all that is selected is drawn, no chunk is missing.
    FrameCounters counters;
};

Selection select(const SelectionInput& input);

// The fewest strata whose points are at least `points` of `pointCount`.
int strataFor(std::uint32_t pointCount, std::uint32_t points);

} // namespace stipple
