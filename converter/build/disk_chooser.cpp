#include "converter/build/disk_chooser.hpp"

#include <algorithm>

namespace stipple {

namespace {
// Points are visited in blocks of so many neighbours in Morton order, and spread evenly inside a block: the
// cells they look into stay in the cache.
constexpr int visitBits = 12;
constexpr std::uint32_t visitBlock = 1u << visitBits;

constexpr std::uint32_t reversedBits(std::uint32_t value) {
    std::uint32_t result = 0;
    for (int i = 0; i < visitBits; ++i)
        result |= (value >> i & 1u) << (visitBits - 1 - i);
    return result;
}
} // namespace

DiskChooser::DiskChooser(const Subtree& subtree, const Spacing& spacing,
                         std::span<const Borders* const> neighbours, int workers)
    : subtree_(subtree), spacing_(spacing), neighbours_(neighbours),
      samplers_(static_cast<std::size_t>(workers)), borders_(subtree.nodes().size()) {
    for (std::size_t i = 0; i < subtree.nodes().size(); ++i)
        indexOf_.emplace(subtree.nodes()[i].key, i);
}

int DiskChooser::nodeBits(std::size_t node) const {
    return subtree_.cube().nodeBits(subtree_.nodes()[node].key.level);
}

void DiskChooser::choose(const Candidates& candidates, int worker, std::span<std::uint8_t> taken) {
    DiskSampler& sampler = samplers_[static_cast<std::size_t>(worker)];
    int bits = nodeBits(candidates.node);
    sampler.begin(bits, spacing_.metric.weights, spacing_.squaredSteps(bits));
    blockNeighbours(subtree_.nodes()[candidates.node].key, sampler);
    auto count = static_cast<std::uint32_t>(candidates.ranks.size());
    for (std::uint32_t block = 0; block < count; block += visitBlock)
        for (std::uint32_t i = 0; i < visitBlock; ++i) {
            std::uint32_t at = block + reversedBits(i);
            if (at >= count)
                continue;
            Vec3<std::uint32_t> p = candidates.positions[at];
            taken[at] = sampler.accept({p.x, p.y, p.z}) ? 1 : 0;
        }
    noteBorder(candidates, taken);
}

void DiskChooser::blockNeighbours(const NodeKey& node, DiskSampler& sampler) const {
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
            block(borders_[found->second], corner, bits, sampler);
        // Leaves of this subtree, too, may be roots of others that were sampled before.
        for (const Borders* borders : neighbours_)
            if (auto outside = borders->find(key); outside != borders->end())
                block(outside->second, corner, bits, sampler);
    }
}

void DiskChooser::block(const std::vector<Vec3i>& borders, Vec3i corner, int bits,
                        DiskSampler& sampler) const {
    double squaredDistance = spacing_.squaredSteps(bits);
    for (Vec3i border : borders)
        if (reaches(border - corner, std::int64_t{1} << bits, squaredDistance))
            sampler.block(border - corner);
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

// Keeps the taken points that a neighbour has to know of.
void DiskChooser::noteBorder(const Candidates& candidates, std::span<const std::uint8_t> taken) {
    int bits = nodeBits(candidates.node);
    double squaredDistance = spacing_.squaredSteps(bits);
    std::int64_t last = (std::int64_t{1} << bits) - 1;
    for (std::size_t i = 0; i < taken.size(); ++i) {
        if (taken[i] == 0)
            continue;
        Vec3<std::uint32_t> p = candidates.positions[i];
        if (nearFace({p.x, p.y, p.z}, last, squaredDistance))
            borders_[candidates.node].push_back(subtree_.position(candidates.ranks[i]));
    }
}

// Whether a point beyond a face of a cube of `last` + 1 steps could be too near to `p` in it.
bool DiskChooser::nearFace(Vec3i p, std::int64_t last, double squaredDistance) const {
    for (int axis = 0; axis < 3; ++axis) {
        // To the nearest point a neighbour could have: one step beyond the face.
        double distance =
            static_cast<double>(std::min(p[axis], last - p[axis]) + 1) * spacing_.metric.weights[axis];
        if (distance * distance < squaredDistance && spacing_.metric.weights[axis] > 0)
            return true;
    }
    return false;
}

// Other subtrees have to know of what lies near the subtree's own faces.
void DiskChooser::finishLevel(std::size_t begin, std::size_t end) {
    int rootBits = subtree_.cube().nodeBits(subtree_.key().level);
    Vec3i corner = subtree_.cube().nodeMin(subtree_.key());
    std::int64_t last = (std::int64_t{1} << rootBits) - 1;
    for (std::size_t i = begin; i < end; ++i) {
        double squaredDistance = spacing_.squaredSteps(nodeBits(i));
        std::vector<Vec3i> outer;
        for (Vec3i border : borders_[i])
            if (nearFace(border - corner, last, squaredDistance))
                outer.push_back(border);
        if (!outer.empty())
            outer_.emplace(subtree_.nodes()[i].key, std::move(outer));
        borders_[i] = {};
    }
}

} // namespace stipple
