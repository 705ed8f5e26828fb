#include "client/core/continuous_selection.hpp"

#include "client/core/continuous_detail.hpp"
#include "client/core/selection_builder.hpp"

#include <algorithm>
#include <array>
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

// Where a node's points are taken to be when it is counted how many show: the middles of so many cells a
// side.
constexpr int cellsAcross = 3;
constexpr int cells = cellsAcross * cellsAcross * cellsAcross;

constexpr std::size_t noParent = ~std::size_t{0};

struct Candidate {
    double reach; // reachPixels() where the node is nearest
    double pixel; // world units of a pixel there
    RankDensity density;
    std::uint32_t cloud, node;
    const HierarchyNode* known;
    std::size_t parent;                // place among the visited
    std::array<float, cells> pixels{}; // world units of a pixel in each cell; infinite out of the picture

    // std::priority_queue takes the largest.
    bool operator<(const Candidate& other) const {
        if (reach != other.reach)
            return reach < other.reach;
        if (cloud != other.cloud)
            return cloud > other.cloud;
        return known->entry.key > other.known->entry.key;
    }
};

struct Total {
    double sent = 0, shown = 0, bytes = 0;
};

class ContinuousSelector {
  public:
    explicit ContinuousSelector(const SelectionInput& input) : input_(input), builder_(input) {}

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
    double pixelOf(const BoxD& box) const {
        bool perspective = input_.view.projection == Projection::perspective;
        double distance = perspective ? builder_.frustum().nearestDistance(box) : 0;
        return pixelWorld(input_.view, input_.height, std::max(distance, input_.view.near));
    }
    static std::uint32_t prefixOf(const Candidate& visited, double target) {
        return detailPrefix(visited.density, visited.known->entry.pointCount, target * visited.pixel);
    }
    // Of `points` in the node's prefix, those that are likely to be in the picture and far enough apart.
    static double shownOf(const Candidate& visited, double target, std::uint32_t points) {
        double shown = 0;
        for (float pixel : visited.pixels)
            if (std::isfinite(pixel))
                shown += std::min(
                    points, detailPrefix(visited.density, visited.known->entry.pointCount, target * pixel));
        return shown / cells;
    }
    bool exceeds(Total total) const {
        auto budget = static_cast<double>(input_.pointBudget);
        return total.shown > budget || total.sent > sentPerShown * budget ||
               total.bytes > static_cast<double>(input_.byteBudget);
    }
    void send(Total& total, std::uint32_t cloud, std::uint32_t points) const {
        total.sent += points;
        total.bytes += static_cast<double>(points) * std::max(1u, input_.clouds[cloud].bytesPerPoint);
    }

    void offerRoots() {
        for (std::size_t c = 0; c < input_.clouds.size(); ++c)
            if (const Hierarchy* hierarchy = input_.clouds[c].hierarchy; hierarchy && hierarchy->size() > 0) {
                counters().nodesKnown += hierarchy->size();
                offer(static_cast<std::uint32_t>(c), 0, noParent);
            }
    }

    void offer(std::uint32_t cloud, std::uint32_t node, std::size_t parent) {
        const HierarchyNode& known = input_.clouds[cloud].hierarchy->node(node);
        if (!builder_.inView(known))
            return;
        const NodeKey& key = known.entry.key;
        double pixel = pixelOf(known.geometry.box);
        RankDensity density =
            rankDensity(key.level, input_.clouds[cloud].hierarchy->spacingOf(key), known.entry.pointCount);
        double reach = reachPixels(density, pixel);
        if (reach <= input_.detailPixels) {
            ++counters().nodesTooSmall;
            return;
        }
        counters().pointsConsidered += known.entry.pointCount;
        queue_.push({reach, pixel, density, cloud, node, &known, parent});
    }

    void visit() {
        Total whole; // what shows at any target below the next reach
        while (!queue_.empty()) {
            Candidate next = queue_.top();
            for (; !notWhole_.empty() && notWhole_.top().first >= next.reach; notWhole_.pop())
                send(whole, visited_[notWhole_.top().second].cloud,
                     visited_[notWhole_.top().second].known->entry.pointCount);
            if (exceeds(whole))
                return;
            queue_.pop();
            ++counters().nodesVisited;
            notWhole_.emplace(wholeAt(next), visited_.size());
            visited_.push_back(next);
            locate(visited_.back());
            for (std::int32_t child : next.known->children)
                if (child >= 0)
                    offer(next.cloud, static_cast<std::uint32_t>(child), visited_.size() - 1);
        }
    }

    // The target at which the last of the node's points shows.
    static double wholeAt(const Candidate& candidate) {
        RankDensity last = candidate.density;
        last.base += last.step * candidate.known->entry.pointCount;
        return reachPixels(last, candidate.pixel);
    }

    void locate(Candidate& visited) const {
        const BoxD& box = visited.known->geometry.box;
        Vec3d step = (box.max - box.min) * (1.0 / cellsAcross);
        for (int cell = 0; cell < cells; ++cell) {
            Vec3d place{cell % cellsAcross + 0.5, cell / cellsAcross % cellsAcross + 0.5,
                        cell / (cellsAcross * cellsAcross) + 0.5};
            Vec3d at =
                box.min - input_.view.eye + Vec3d{place.x * step.x, place.y * step.y, place.z * step.z};
            double pixel = inPicture(at)
                               ? pixelWorld(input_.view, input_.height, dot(at, input_.view.forward))
                               : HUGE_VAL;
            visited.pixels[static_cast<std::size_t>(cell)] = static_cast<float>(pixel);
        }
    }
    // `at`: from the eye.
    bool inPicture(Vec3d at) const {
        const ViewTransform& view = input_.view;
        double depth = dot(at, view.forward);
        double half = view.projection == Projection::perspective ? view.tanHalfFovY * depth : view.halfHeight;
        return depth >= view.near && std::abs(dot(at, view.right)) <= half * view.aspect &&
               std::abs(dot(at, view.up)) <= half;
    }

    Total totalAt(double target) const {
        Total total;
        for (const Candidate& visited : visited_) {
            std::uint32_t points = prefixOf(visited, target);
            send(total, visited.cloud, points);
            total.shown += shownOf(visited, target, points);
        }
        return total;
    }

    // The least target, from the wanted one up, within both budgets, to a part in a thousand. Nodes that were
    // not visited would not show there.
    double affordableTarget() const {
        double low = input_.detailPixels;
        if (!queue_.empty())
            low = std::max(low, queue_.top().reach);
        if (!exceeds(totalAt(low)))
            return low;
        double high = std::max(low, coarsestPixels);
        if (exceeds(totalAt(high)))
            return high;
        while (high > 1.001 * low) {
            double middle = std::sqrt(low * high);
            (exceeds(totalAt(middle)) ? low : high) = middle;
        }
        return high;
    }

    void emit(double target) {
        std::vector<bool> childrenMayShow(visited_.size());
        for (std::size_t i = 0; i < visited_.size(); ++i) {
            const Candidate& node = visited_[i];
            bool ancestorsDrawn = node.parent == noParent || childrenMayShow[node.parent];
            std::uint32_t prefix = prefixOf(node, target), points = affordable(node.cloud, prefix);
            counters().pointsExpected += static_cast<std::uint64_t>(shownOf(node, target, points));
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
        return reachPixels(rankDensity(key.level + 1, spacing, 1u << 30), pixelOf(child.box));
    }

    const SelectionInput& input_;
    SelectionBuilder builder_;
    std::priority_queue<Candidate> queue_;
    Total taken_;
    std::vector<Candidate> visited_;                               // parents before children
    std::priority_queue<std::pair<double, std::size_t>> notWhole_; // wholeAt(), place among the visited
};

} // namespace

Selection selectContinuous(const SelectionInput& input) {
    return ContinuousSelector(input).run();
}

} // namespace stipple
