#include "client/core/continuous_selection.hpp"

#include "client/core/continuous_detail.hpp"
#include "client/core/expected_points.hpp"
#include "client/core/selection_builder.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <utility>
#include <vector>

namespace stipple {

namespace {

// What holds the eye shows whole at any target, level upon level. Where the budget has no room even for that,
// a larger target would only empty the rest of the picture; nodes are cut off then, coarsest first to stay.
constexpr double coarsestPixels = 32;

// The point budget is of points that show. A prefix holds others as well, out of the picture or too far for
// their spacing, which cost a rasterizer less; so many times the budget may be sent to it in all.
constexpr double sentPerShown = 4;

constexpr std::size_t noParent = ~std::size_t{0};

// A node that is offered or visited.
struct Candidate {
    double reach; // reachPixels() where the node is nearest
    double pixel; // world units of a pixel there
    RankDensity density;
    std::uint32_t cloud, node;
    const HierarchyNode* known;
    std::size_t parent; // place among the visited
    Sight sight;
};

// What the queue holds of it: little, since it is moved often.
struct Place {
    double reach;
    std::uint32_t cloud;
    std::uint32_t candidate; // index
    const NodeKey* key;

    // std::priority_queue takes the largest.
    bool operator<(const Place& other) const {
        if (reach != other.reach)
            return reach < other.reach;
        if (cloud != other.cloud)
            return cloud > other.cloud;
        return *key > *other.key;
    }
};

struct Total {
    double sent = 0, shown = 0, bytes = 0;
};

class ContinuousSelector {
  public:
    explicit ContinuousSelector(const SelectionInput& input)
        : input_(input), builder_(input), expected_(input.view, input.height) {}

    Selection run() {
        offerRoots();
        visit();
        double target = affordableTarget();
        counters().nodesOverBudget += queue_.size();
        counters().detailPixels = target;
        emit(target);
        return builder_.finish();
    }

  private:
    FrameCounters& counters() { return builder_.counters(); }

    // World units of a pixel where the box is nearest.
    double pixelOf(const BoxD& box, Sight sight) const {
        bool perspective = input_.view.projection == Projection::perspective;
        double distance = perspective ? builder_.frustum().nearestDistance(box, sight) : 0;
        return pixelWorld(input_.view, input_.height, std::max(distance, input_.view.near));
    }
    static std::uint32_t prefixOf(const Candidate& visited, double target) {
        return detailPrefix(visited.density, visited.known->entry.pointCount, target * visited.pixel);
    }
    // The largest part that a budget has of the total: more than 1 exceeds it.
    double fillOf(Total total) const {
        double budget = std::max<double>(static_cast<double>(input_.pointBudget), 1e-9);
        return std::max({total.shown / budget, total.sent / (sentPerShown * budget),
                         total.bytes / std::max<double>(static_cast<double>(input_.byteBudget), 1e-9)});
    }
    bool exceeds(Total total) const { return fillOf(total) > 1; }
    void send(Total& total, std::uint32_t cloud, std::uint32_t points) const {
        total.sent += points;
        total.bytes += static_cast<double>(points) * std::max(1u, input_.clouds[cloud].bytesPerPoint);
    }

    void offerRoots() {
        for (std::size_t c = 0; c < input_.clouds.size(); ++c)
            if (const Hierarchy* hierarchy = input_.clouds[c].hierarchy; hierarchy && hierarchy->size() > 0) {
                counters().nodesKnown += hierarchy->size();
                offer(static_cast<std::uint32_t>(c), 0, noParent, Sight::crossing);
            }
    }

    void offer(std::uint32_t cloud, std::uint32_t node, std::size_t parent, Sight parentSight) {
        const HierarchyNode& known = input_.clouds[cloud].hierarchy->node(node);
        Sight sight = builder_.sightOf(known, parentSight);
        if (sight == Sight::outside)
            return;
        const NodeKey& key = known.entry.key;
        double pixel = pixelOf(known.geometry.box, sight);
        RankDensity density = input_.clouds[cloud].hierarchy->densityOf(node);
        double reach = reachPixels(density, pixel);
        if (reach <= input_.detailPixels) {
            ++counters().nodesTooSmall;
            return;
        }
        counters().pointsConsidered += known.entry.pointCount;
        queue_.push({reach, cloud, static_cast<std::uint32_t>(offered_.size()), &key});
        offered_.push_back({reach, pixel, density, cloud, node, &known, parent, sight});
    }

    void visit() {
        Total whole; // what shows at any target below the next reach
        while (!queue_.empty()) {
            Place next = queue_.top();
            for (; !notWhole_.empty() && notWhole_.top().first >= next.reach; notWhole_.pop())
                send(whole, visited_[notWhole_.top().second].cloud,
                     visited_[notWhole_.top().second].known->entry.pointCount);
            if (exceeds(whole))
                return;
            queue_.pop();
            ++counters().nodesVisited;
            visited_.push_back(offered_[next.candidate]);
            const Candidate visited = visited_.back();
            std::size_t place = visited_.size() - 1;
            notWhole_.emplace(wholeAt(visited), place);
            expected_.add(visited.known->geometry.box, visited.density, visited.known->entry.pointCount);
            for (std::int32_t child : visited.known->children)
                if (child >= 0)
                    offer(visited.cloud, static_cast<std::uint32_t>(child), place, visited.sight);
        }
    }

    // The target at which the last of the node's points shows.
    static double wholeAt(const Candidate& candidate) {
        RankDensity last = candidate.density;
        last.base += last.step * candidate.known->entry.pointCount;
        return reachPixels(last, candidate.pixel);
    }

    Total totalAt(double target) const {
        Total total;
        for (const Candidate& visited : visited_)
            send(total, visited.cloud, prefixOf(visited, target));
        total.shown = expected_.shownAt(target);
        return total;
    }

    // The least target, from the wanted one up, within both budgets, to a part in a thousand. Nodes that were
    // not visited would not show there. What a budget holds is nearly linear in 1 / target²: false position
    // (Dowell, Jarratt 1971, "Illinois") finds it in a few steps.
    double affordableTarget() const {
        double target = input_.detailPixels;
        if (!queue_.empty())
            target = std::max(target, queue_.top().reach);
        double over = fillOf(totalAt(target)) - 1;
        if (over <= 0)
            return target;
        double coarsest = std::max(target, coarsestPixels), under = fillOf(totalAt(coarsest)) - 1;
        if (under > 0)
            return coarsest;
        auto density = [](double pixels) { return 1 / (pixels * pixels); };
        double most = density(target), least = density(coarsest); // over and within the budgets
        double overWeight = over, underWeight = under;
        bool wasOver = false, isFirst = true;
        while (most > 1.002 * least) {
            double next = least - underWeight * (most - least) / (overWeight - underWeight);
            // Off the ends, so that both come nearer.
            next = std::clamp(next, 1.0005 * least, most / 1.0005);
            double fill = fillOf(totalAt(1 / std::sqrt(next))) - 1;
            bool isOver = fill > 0;
            (isOver ? most : least) = next;
            (isOver ? overWeight : underWeight) = fill;
            if (!isFirst && isOver == wasOver)
                (isOver ? underWeight : overWeight) /= 2;
            wasOver = isOver;
            isFirst = false;
        }
        return 1 / std::sqrt(least);
    }

    void emit(double target) {
        std::vector<bool> childrenMayShow(visited_.size());
        for (std::size_t i = 0; i < visited_.size(); ++i) {
            const Candidate& node = visited_[i];
            bool ancestorsDrawn = node.parent == noParent || childrenMayShow[node.parent];
            std::uint32_t prefix = prefixOf(node, target), points = affordable(node.cloud, prefix);
            counters().pointsExpected += static_cast<std::uint64_t>(expected_.shownOf(i, target, points));
            counters().pointsTooFine += node.known->entry.pointCount - prefix;
            counters().nodesOverBudget += points < prefix;
            childrenMayShow[i] = ancestorsDrawn;
            if (points > 0)
                childrenMayShow[i] = builder_.choose(
                    node.cloud, node.node, builder_.pixelsOf(node.known->geometry), points, ancestorsDrawn);
            if (node.known->childrenState == ChildrenState::missing)
                builder_.wantChunk(node.cloud, node.node, target,
                                   [&](const NodeGeometry& child) { return childReach(node, child); });
        }
    }

    // How many of so many points the budgets still allow; takes them off.
    std::uint32_t affordable(std::uint32_t cloud, std::uint32_t points) {
        double perPoint = std::max(1u, input_.clouds[cloud].bytesPerPoint);
        double room = std::min(sentPerShown * static_cast<double>(input_.pointBudget) - taken_.sent,
                               (static_cast<double>(input_.byteBudget) - taken_.bytes) / perPoint);
        points = static_cast<std::uint32_t>(std::clamp(std::floor(room), 0.0, static_cast<double>(points)));
        send(taken_, cloud, points);
        return points;
    }

    // Nothing is known of the child but its place: as if it had many points.
    double childReach(const Candidate& parent, const NodeGeometry& child) const {
        const NodeKey& key = parent.known->entry.key;
        double spacing = input_.clouds[parent.cloud].hierarchy->spacingOf(key) / 2;
        return reachPixels(rankDensity(key.level + 1, spacing, 1u << 30),
                           pixelOf(child.box, Sight::crossing));
    }

    const SelectionInput& input_;
    SelectionBuilder builder_;
    std::priority_queue<Place> queue_;
    std::vector<Candidate> offered_;
    Total taken_;
    std::vector<Candidate> visited_;                               // parents before children
    ExpectedPoints expected_;                                      // of the visited
    std::priority_queue<std::pair<double, std::size_t>> notWhole_; // wholeAt(), place among the visited
};

} // namespace

Selection selectContinuous(const SelectionInput& input) {
    return ContinuousSelector(input).run();
}

} // namespace stipple
