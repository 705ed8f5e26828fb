#include "client/core/selection.hpp"

#include "client/core/continuous_selection.hpp"
#include "client/core/selection_builder.hpp"

#include <algorithm>
#include <queue>

namespace stipple {

namespace {

struct Candidate {
    double priority, pixels;
    std::uint32_t cloud, node;
    const HierarchyNode* known;
    bool ancestorsDrawn; // all that hold points are here, or will never be
    Sight sight;

    // std::priority_queue takes the largest.
    bool operator<(const Candidate& other) const {
        if (priority != other.priority)
            return priority < other.priority;
        if (cloud != other.cloud)
            return cloud > other.cloud;
        return known->entry.key > other.known->entry.key;
    }
};

class DiscreteSelector {
  public:
    explicit DiscreteSelector(const SelectionInput& input) : input_(input), builder_(input) {}

    Selection run() {
        for (std::size_t c = 0; c < input_.clouds.size(); ++c)
            if (const Hierarchy* hierarchy = input_.clouds[c].hierarchy; hierarchy && hierarchy->size() > 0) {
                counters().nodesKnown += hierarchy->size();
                offer(static_cast<std::uint32_t>(c), 0, nullptr, true);
            }
        while (!queue_.empty() && !full_) {
            Candidate next = queue_.top();
            queue_.pop();
            take(next);
        }
        counters().nodesOverBudget += queue_.size();
        return builder_.finish();
    }

  private:
    FrameCounters& counters() { return builder_.counters(); }

    void offer(std::uint32_t cloud, std::uint32_t node, const Candidate* parent, bool ancestorsDrawn) {
        const HierarchyNode& known = input_.clouds[cloud].hierarchy->node(node);
        Sight sight = builder_.sightOf(known, parent ? parent->sight : Sight::crossing);
        if (sight == Sight::outside)
            return;
        double pixels = builder_.pixelsOf(known.geometry);
        if (pixels < input_.minNodePixels && parent)
            ++counters().nodesTooSmall;
        else {
            counters().pointsConsidered += known.entry.pointCount;
            const BoxD& box = known.geometry.box;
            double weight = priorityWeight(input_.weights, input_.view, box.min + (box.max - box.min) * 0.5);
            queue_.push({weight * pixels, pixels, cloud, node, &known, ancestorsDrawn, sight});
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
            drawn = builder_.choose(next.cloud, next.node, next.pixels, points, next.ancestorsDrawn);
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

    void expand(const Candidate& parent, bool drawn) {
        if (parent.known->childrenState == ChildrenState::missing) {
            builder_.wantChunk(parent.cloud, parent.node, input_.minNodePixels,
                               [&](const NodeGeometry& geometry) { return builder_.pixelsOf(geometry); });
            return;
        }
        for (std::int32_t child : parent.known->children)
            if (child >= 0)
                offer(parent.cloud, static_cast<std::uint32_t>(child), &parent, drawn);
    }

    const SelectionInput& input_;
    SelectionBuilder builder_;
    std::priority_queue<Candidate> queue_;
    std::uint64_t pointsTaken_ = 0, bytesTaken_ = 0;
    bool full_ = false;
};

} // namespace

Selection select(const SelectionInput& input) {
    return input.detailPixels > 0 ? selectContinuous(input) : DiscreteSelector(input).run();
}

int strataFor(std::uint32_t pointCount, std::uint32_t points) {
    int strata = 1;
    while (strata < strataCount && strataPrefixPoints(pointCount, strata) < points)
        ++strata;
    return strata;
}

} // namespace stipple
