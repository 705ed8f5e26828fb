// Dynamic batching (Wu et al. 2021, UnityPIC §4.2 and §4.3.1): the competitor of the octree texture
// (client/render/drawn_octree.hpp) for adaptive sizes, for batching_bench alone. Each drawn node gets a list
// of its own points and of those that its parent's list has within its bounds (which holds those of all
// ancestors), sorted by octant. Where a child is drawn, it draws the octant's points; the rest a node draws
// itself. So all points of a node that are drawn have one size, and no shader has to look for it.
//
//   own and inherited   | octant 0 | octant 1 | … | octant 7 |       octants: where each begins
//   child 1 is drawn      drawn      child's        drawn            runs: {0, …}, {octants[2], …}
//
// Other than there: no geometry shader (OpenGL ES has none before 3.2, WebGL none at all) drops what is not
// drawn; octants that lie one behind the other are one draw call. Nodes that are not drawn but lie between
// two that are get lists too, of inherited points alone and of the ancestor's size.
#pragma once

#include "client/core/frame_plan.hpp"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace stipple {

class Frustum;

struct BatchRun {
    std::uint32_t first = 0, count = 0;
};

struct BatchCounters {
    std::uint64_t listsMade = 0, pointsMade = 0; // by the last update: lists that were not there as they are
    std::uint64_t drawCalls = 0, vertices = 0;   // of the runs
    // As the paper draws: a call for each list of which something is drawn, all of its points being vertices.
    std::uint64_t listCalls = 0, listVertices = 0;
    std::uint64_t ownPoints = 0, listPoints = 0; // drawn nodes: without and with what they inherit
    std::uint64_t bytes = 0;                     // of all lists that are kept
};

class PointBatches {
  public:
    // `leaveOutUnseen`: octants outside the view are not drawn (the paper's visibility mask).
    explicit PointBatches(bool leaveOutUnseen = false) : leaveOutUnseen_(leaveOutUnseen) {}

    // Makes the lists of the plan's nodes; those that stand from the updates before are kept. `plan` draws
    // whole prefixes (continuous detail would need each point's rank as a vertex attribute).
    void update(const FramePlan& plan);

    // The nodes with something to draw: their points are their lists, `spacing` is that of all that is drawn
    // of them. Without paints: lists hold colours as painted.
    const FramePlan& plan() const { return plan_; }
    const std::vector<BatchRun>& runs(std::size_t node) const {
        return runs_[node];
    } // index into plan().nodes
    const BatchCounters& counters() const { return counters_; }

  private:
    struct Place {
        std::uint32_t cloud = 0;
        NodeKey key;
        friend bool operator==(const Place&, const Place&) = default;
    };
    struct PlaceHash {
        std::size_t operator()(const Place& place) const { return NodeKeyHash()(place.key) + place.cloud; }
    };
    // What a list was made of. Ids are unique among nodes, paints and lists.
    struct Origin {
        std::uint64_t node = 0, colours = 0, parentList = 0;
        std::uint32_t points = 0;
        friend bool operator==(const Origin&, const Origin&) = default;
    };
    struct List {
        Origin origin;
        std::shared_ptr<const ResidentNode> points;
        std::array<std::uint32_t, 9> octants{};
        std::uint64_t lastUpdate = 0;
    };
    // A node of the drawn octree, with its list.
    struct Step {
        Place place;
        DrawNode node; // `spacing`: of what it draws
        const List* list = nullptr;
    };

    void take(const Step* parent, int octant, const DrawNode* own, Step& step);
    const List& listOf(const Step& step, const DrawNode* own, const Step* parent, int octant);
    void addToPlan(const Step& step, std::uint32_t children, const Frustum& frustum);
    void forget();

    bool leaveOutUnseen_;
    std::unordered_map<Place, List, PlaceHash> lists_;
    FramePlan plan_;
    std::vector<std::vector<BatchRun>> runs_;
    BatchCounters counters_;
    std::uint64_t updates_ = 0;
};

// The same picture for the software renderer, which draws prefixes and knows sizes of frames alone: nodes of
// what is drawn, each the only one of its cloud, so that the walk through the octree ends where it begins.
FramePlan planOfRuns(const PointBatches& batches);

} // namespace stipple
