#include "converter/build/disk_chooser.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {
// Points are visited in blocks of so many neighbours in Morton order, and spread evenly inside a block: the
// cells they look into stay in the cache.
constexpr int visitBits = 12;
constexpr std::uint32_t visitBlock = 1u << visitBits;

constexpr auto visitOrder = [] { // bit-reversed
    std::array<std::uint16_t, visitBlock> order{};
    for (std::uint32_t value = 0; value < visitBlock; ++value)
        for (int bit = 0; bit < visitBits; ++bit)
            order[value] =
                static_cast<std::uint16_t>(order[value] | (value >> bit & 1u) << (visitBits - 1 - bit));
    return order;
}();

// Where a point in a cube could be too near to one beyond the cube's faces.
class FaceZone {
  public:
    // A cube of 2^cubeBits steps; points keep the distance of nodes of 2^nodeBits steps.
    FaceZone(const Spacing& spacing, int cubeBits, int nodeBits) : last_((std::int64_t{1} << cubeBits) - 1) {
        const double distance = std::sqrt(spacing.squaredSteps(nodeBits));
        for (int axis = 0; axis < 3; ++axis) {
            const double weight = spacing.metric.weights[axis];
            auto isNear = [&](std::int64_t steps) { // the comparison that sampling makes
                double side = static_cast<double>(steps) * weight;
                return side * side < spacing.squaredSteps(nodeBits);
            };
            if (weight == 0)
                continue;
            // The nearest point a neighbour could have is one step beyond the face.
            std::int64_t& width = width_[axis];
            width = static_cast<std::int64_t>(std::min(distance / weight, static_cast<double>(last_)));
            while (width <= last_ && isNear(width + 1))
                ++width;
            while (width > 0 && !isNear(width))
                --width;
        }
    }

    bool holds(Vec3i p) const {
        for (int axis = 0; axis < 3; ++axis)
            if (std::min(p[axis], last_ - p[axis]) < width_[axis])
                return true;
        return false;
    }

  private:
    std::int64_t last_;
    Vec3i width_; // steps from a face
};
} // namespace

static_assert(DiskThinning::outside == nobody);

DiskChooser::DiskChooser(const Subtree& subtree, const Spacing& spacing,
                         std::span<const Borders* const> neighbours, int workers, bool wantsRepresentatives)
    : subtree_(subtree), spacing_(spacing), neighbours_(neighbours),
      thinnings_(static_cast<std::size_t>(workers)), wantsRepresentatives_(wantsRepresentatives),
      borders_(subtree.nodes().size()) {
    for (std::size_t i = 0; i < subtree.nodes().size(); ++i)
        indexOf_.emplace(subtree.nodes()[i].key, i);
}

int DiskChooser::nodeBits(std::size_t node) const {
    return subtree_.cube().nodeBits(subtree_.nodes()[node].key.level);
}

void DiskChooser::choose(const Candidates& candidates, int worker, std::span<std::uint32_t> representatives) {
    DiskThinning& thinning = thinnings_[static_cast<std::size_t>(worker)];
    int bits = nodeBits(candidates.node);
    thinning.begin(bits, spacing_.metric.weights, spacing_.squaredSteps(bits), candidates.positions);
    blockNeighbours(subtree_.nodes()[candidates.node].key, thinning);
    const FaceZone border(spacing_, bits, bits);
    std::vector<Vec3i>& borders = borders_[candidates.node];
    auto count = static_cast<std::uint32_t>(candidates.ranks.size());
    std::fill(representatives.begin(), representatives.end(), nobody);
    for (std::uint32_t block = 0; block < count; block += visitBlock)
        for (std::uint32_t inBlock : visitOrder) {
            std::uint32_t at = block + inBlock;
            if (at >= count || !thinning.isFree(at))
                continue;
            Vec3i p{candidates.positions[at].x, candidates.positions[at].y, candidates.positions[at].z};
            representatives[at] = at;
            thinning.exclude(p, wantsRepresentatives_ ? at : nobody);
            if (border.holds(p)) // a neighbour has to know of it
                borders.push_back(subtree_.position(candidates.ranks[at]));
        }
    for (std::uint32_t i = 0; i < count && wantsRepresentatives_; ++i)
        representatives[i] = thinning.excludedBy(i);
}

void DiskChooser::blockNeighbours(const NodeKey& node, DiskThinning& thinning) const {
    int bits = subtree_.cube().nodeBits(node.level);
    Vec3i corner = subtree_.cube().nodeMin(node);
    for (int d = 0; d < 27; ++d) {
        NodeKey key = node; // steps below 0 wrap round to keys that do not exist
        key.x += static_cast<std::uint32_t>(d % 3 - 1);
        key.y += static_cast<std::uint32_t>(d / 3 % 3 - 1);
        key.z += static_cast<std::uint32_t>(d / 9 - 1);
        if (key == node)
            continue;
        if (auto found = indexOf_.find(key); found != indexOf_.end())
            block(borders_[found->second], corner, bits, thinning);
        // Leaves of this subtree, too, may be roots of others that were sampled before.
        for (const Borders* borders : neighbours_)
            if (auto outside = borders->find(key); outside != borders->end())
                block(outside->second, corner, bits, thinning);
    }
}

void DiskChooser::block(const std::vector<Vec3i>& borders, Vec3i corner, int bits,
                        DiskThinning& thinning) const {
    double squaredDistance = spacing_.squaredSteps(bits);
    for (Vec3i border : borders)
        if (reaches(border - corner, std::int64_t{1} << bits, squaredDistance))
            thinning.exclude(border - corner, nobody);
}

// Whether `p`, in steps from the node's corner, is within the minimum distance of the node's box on the
// axis, seen from outside.
bool DiskChooser::reaches(Vec3i p, std::int64_t side, double squaredDistance) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        std::int64_t out = p[axis] < 0 ? -p[axis] : p[axis] >= side ? p[axis] - (side - 1) : 0;
        double distance = static_cast<double>(out) * spacing_.metric.weights[axis];
        sum += distance * distance;
    }
    return sum < squaredDistance;
}

// Other subtrees have to know of what lies near the subtree's own faces.
void DiskChooser::finishLevel(std::size_t begin, std::size_t end) {
    int rootBits = subtree_.cube().nodeBits(subtree_.key().level);
    Vec3i corner = subtree_.cube().nodeMin(subtree_.key());
    for (std::size_t i = begin; i < end; ++i) {
        const FaceZone zone(spacing_, rootBits, nodeBits(i));
        std::vector<Vec3i> outer;
        for (Vec3i border : borders_[i])
            if (zone.holds(border - corner))
                outer.push_back(border);
        if (!outer.empty())
            outer_.emplace(subtree_.nodes()[i].key, std::move(outer));
        borders_[i] = {};
    }
}

} // namespace stipple
