#include "client/core/selection.hpp"

#include "client/core/frustum.hpp"

#include <algorithm>
#include <queue>

namespace stipple {

namespace {

// A node whose radius spans this part of the picture's height is coarse: its first stratum alone is fetched
// first, ahead of everything finer, so that the whole view fills early. Finer nodes come in one piece, since
// a request of their own for each stratum would cost more round trips than it saves bytes.
constexpr double coarseHeights = 0.5;

struct Candidate {
    double pixels;
    std::uint32_t cloud, node;
    const HierarchyNode* known;
    bool ancestorsDrawn; // all that hold points are here, or will never be

    // std::priority_queue takes the largest.
    bool operator<(const Candidate& other) const {
        if (pixels != other.pixels)
            return pixels < other.pixels;
        if (cloud != other.cloud)
            return cloud > other.cloud;
        return known->entry.key > other.known->entry.key;
    }
};

class Selector {
  public:
    explicit Selector(const SelectionInput& input) : input_(input), frustum_(input.view) {}

    Selection run() {
        for (std::size_t c = 0; c < input_.clouds.size(); ++c)
            if (const Hierarchy* hierarchy = input_.clouds[c].hierarchy; hierarchy && hierarchy->size() > 0) {
                counters().nodesKnown += hierarchy->size();
                offer(static_cast<std::uint32_t>(c), 0, true, true);
            }
        while (!queue_.empty() && !full_) {
            Candidate next = queue_.top();
            queue_.pop();
            take(next);
        }
        counters().nodesOverBudget += queue_.size();
        finish();
        return std::move(result_);
    }

  private:
    FrameCounters& counters() { return result_.counters; }

    void offer(std::uint32_t cloud, std::uint32_t node, bool isRoot, bool ancestorsDrawn) {
        const HierarchyNode& known = input_.clouds[cloud].hierarchy->node(node);
        if (!frustum_.intersects(known.geometry.box)) {
            ++counters().nodesOutsideFrustum;
            return;
        }
        double pixels = pixelsOf(known.geometry);
        if (pixels < input_.minNodePixels && !isRoot)
            ++counters().nodesTooSmall;
        else {
            counters().pointsConsidered += known.entry.pointCount;
            queue_.push({pixels, cloud, node, &known, ancestorsDrawn});
        }
    }

    void take(const Candidate& next) {
        ++counters().nodesVisited;
        bool drawn = next.ancestorsDrawn;
        if (next.known->entry.pointCount > 0) {
            std::uint32_t points = affordable(next);
            if (points < next.known->entry.pointCount)
                full_ = true;
            if (points == 0) {
                ++counters().nodesOverBudget;
                return;
            }
            drawn = choose(next, points);
        }
        if (!full_)
            expand(next, drawn);
    }

    // How much of the node both budgets still allow; takes it off them.
    std::uint32_t affordable(const Candidate& next) {
        std::uint64_t perPoint = std::max(1u, input_.clouds[next.cloud].bytesPerPoint);
        std::uint64_t room =
            std::min(input_.pointBudget - pointsTaken_, (input_.byteBudget - bytesTaken_) / perPoint);
        auto points = static_cast<std::uint32_t>(std::min<std::uint64_t>(room, next.known->entry.pointCount));
        pointsTaken_ += points;
        bytesTaken_ += points * perPoint;
        return points;
    }

    // Adds the node to the selection. Returns whether its children may show.
    bool choose(const Candidate& next, std::uint32_t points) {
        const NodeResidency& residency = input_.clouds[next.cloud].residency[next.node];
        SelectedNode selected{next.cloud, next.node, next.pixels, points, 0};
        std::uint32_t here = std::min(points, residency.points);
        if (next.ancestorsDrawn)
            selected.drawPoints = here;
        ++counters().nodesSelected;
        counters().pointsSelected += points;
        counters().pointsDrawn += selected.drawPoints;
        counters().nodesDrawn += selected.drawPoints > 0;
        if (here < points && !residency.failed) {
            ++counters().nodesWaiting;
            want(next, points, residency.points);
        }
        result_.nodes.push_back(selected);
        return next.ancestorsDrawn && (here > 0 || residency.failed);
    }

    void want(const Candidate& next, std::uint32_t points, std::uint32_t here) {
        int strata = strataFor(next.known->entry.pointCount, points);
        bool firstStratumOnly = here == 0 && next.pixels >= coarseHeights * input_.height;
        if (firstStratumOnly)
            beginnings_.push_back({next.cloud, next.node, 1});
        else
            result_.loads.push_back({next.cloud, next.node, strata});
    }

    void expand(const Candidate& parent, bool drawn) {
        const Hierarchy& hierarchy = *input_.clouds[parent.cloud].hierarchy;
        if (parent.known->childrenState == ChildrenState::missing) {
            wantChunk(parent, hierarchy);
            return;
        }
        for (std::int32_t child : parent.known->children)
            if (child >= 0)
                offer(parent.cloud, static_cast<std::uint32_t>(child), false, drawn);
    }

    // The chunk is worth fetching if a child in it would be looked at.
    void wantChunk(const Candidate& parent, const Hierarchy& hierarchy) {
        double largest = -1;
        for (int c = 0; c < 8; ++c) {
            if (!((parent.known->entry.childMask >> c) & 1))
                continue;
            NodeGeometry geometry = hierarchy.geometryOf(parent.known->entry.key.child(c));
            if (frustum_.intersects(geometry.box))
                largest = std::max(largest, pixelsOf(geometry));
        }
        if (largest < 0 || largest < input_.minNodePixels)
            return;
        ++counters().chunksWaiting;
        result_.chunks.push_back({parent.cloud, parent.node, largest});
    }

    double pixelsOf(const NodeGeometry& geometry) const {
        return projectedPixels(input_.view, input_.height, geometry.centre, geometry.radius);
    }

    void finish() {
        result_.loads.insert(result_.loads.begin(), beginnings_.begin(), beginnings_.end());
        std::stable_sort(result_.chunks.begin(), result_.chunks.end(),
                         [](const WantedChunk& a, const WantedChunk& b) { return a.pixels > b.pixels; });
        counters().complete = counters().nodesWaiting == 0 && counters().chunksWaiting == 0;
    }

    const SelectionInput& input_;
    Frustum frustum_;
    std::priority_queue<Candidate> queue_;
    std::uint64_t pointsTaken_ = 0, bytesTaken_ = 0;
    bool full_ = false;
    std::vector<WantedNode> beginnings_;
    Selection result_;
};

} // namespace

Selection select(const SelectionInput& input) {
    return Selector(input).run();
}

int strataFor(std::uint32_t pointCount, std::uint32_t points) {
    int strata = 1;
    while (strata < strataCount && strataPrefixPoints(pointCount, strata) < points)
        ++strata;
    return strata;
}

} // namespace stipple
