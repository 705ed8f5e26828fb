#include "client/core/hierarchy.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {

// Integers up to here are exact in a double, and sums of two of them in an int64.
constexpr std::int64_t maxGridInteger = std::int64_t{1} << 53;

Error corrupt(Phrase what) {
    return {ErrorCode::corrupt, what, "hierarchy", ""};
}

Status checkGrid(const CloudMetadata& metadata) {
    for (int axis = 0; axis < 3; ++axis) {
        double scale = metadata.grid.scale[axis], offset = metadata.grid.offset[axis];
        if (!(scale > 0) || !std::isfinite(scale) || !std::isfinite(offset))
            return corrupt(say("the grid's scale or offset is not a usable number"));
        if (std::abs(static_cast<double>(metadata.rootCube.min[axis])) > static_cast<double>(maxGridInteger))
            return corrupt(say("the root cube lies outside the integers that can be drawn"));
    }
    if (metadata.rootCube.bits < 0 || metadata.rootCube.bits > maxRootBits)
        return corrupt(say("the root cube is 2^", metadata.rootCube.bits, " steps wide"));
    return {};
}

Status checkEntry(const NodeEntry& entry, const RootCube& cube) {
    int nodeBits = cube.nodeBits(entry.key.level);
    if (entry.key.level > maxLevel || nodeBits < 0 || (entry.childMask != 0 && nodeBits == 0))
        return corrupt(say("node ", entry.key.text(), " is smaller than a grid step"));
    if (entry.pointCount > 0 && nodeBits > maxNodeBits)
        return corrupt(say("node ", entry.key.text(), " is too wide to hold points"));
    return {};
}

} // namespace

Result<Hierarchy> Hierarchy::create(std::shared_ptr<const CloudMetadata> metadata,
                                    std::vector<NodeEntry> rootNodes) {
    STIPPLE_CHECK(checkGrid(*metadata));
    Hierarchy hierarchy;
    hierarchy.bounds_ = metadata->worldBounds();
    hierarchy.metadata_ = std::move(metadata);
    if (rootNodes.empty())
        return corrupt(say("the root chunk has no nodes"));
    STIPPLE_CHECK(hierarchy.append(-1, std::move(rootNodes)));
    return hierarchy;
}

Status Hierarchy::add(std::size_t parent, std::vector<NodeEntry> nodes) {
    if (nodes_[parent].childrenState != ChildrenState::missing)
        return corrupt(say("the children of node ", nodes_[parent].entry.key.text(), " came twice"));
    return append(static_cast<std::int32_t>(parent), std::move(nodes));
}

void Hierarchy::markChildrenFailed(std::size_t parent) {
    nodes_[parent].childrenState = ChildrenState::failed;
}

void Hierarchy::markChildrenMissing(std::size_t parent) {
    nodes_[parent].childrenState = ChildrenState::missing;
}

// Entries are appended one by one to a copy of nothing but the end of nodes_; an error cuts it off again.
Status Hierarchy::append(std::int32_t root, std::vector<NodeEntry> entries) {
    std::size_t before = nodes_.size();
    std::uint64_t pointsBefore = points_;
    auto undo = [&](Error error) {
        nodes_.resize(before);
        points_ = pointsBefore;
        if (root >= 0)
            nodes_[static_cast<std::size_t>(root)].children.fill(-1);
        return Status(std::move(error));
    };
    if (entries.size() > maxKnownNodes - std::min(maxKnownNodes, before))
        return undo({ErrorCode::limitExceeded, say("more than ", maxKnownNodes, " nodes"), "hierarchy", ""});

    for (NodeEntry& entry : entries) {
        if (Status status = checkEntry(entry, metadata_->rootCube); !status.ok())
            return undo(status.error());
        HierarchyNode node;
        if (root < 0 && nodes_.empty()) {
            if (entry.key != NodeKey{})
                return undo(corrupt(say("the first node is not the root")));
        } else {
            if (entry.key.level == 0)
                return undo(corrupt(say("a second root")));
            // The parent is the chunk's own parent or a node of this chunk; nothing else may grow.
            node.parent = findFrom(root < 0 ? 0 : root, entry.key.parent());
            bool ours =
                node.parent >= 0 && (node.parent == root || node.parent >= static_cast<std::int32_t>(before));
            if (!ours)
                return undo(corrupt(say("node ", entry.key.text(), " has no parent in its chunk")));
            HierarchyNode& parent = nodes_[static_cast<std::size_t>(node.parent)];
            auto slot = static_cast<std::size_t>(entry.key.indexInParent());
            bool announced = (parent.entry.childMask >> slot) & 1;
            bool belongsHere = node.parent == root || parent.childrenState == ChildrenState::known;
            if (!announced || !belongsHere || parent.children[slot] >= 0)
                return undo(corrupt(say("node ", entry.key.text(), " was not announced, or comes twice")));
            parent.children[slot] = static_cast<std::int32_t>(nodes_.size());
        }
        points_ += entry.pointCount;
        if (points_ > metadata_->pointCount)
            return undo(corrupt(say("the nodes hold more points than the cloud's ", metadata_->pointCount)));
        node.geometry = geometryOf(entry.key);
        if (entry.childMask != 0 && entry.childChunk.size > 0)
            node.childrenState = ChildrenState::missing;
        node.entry = std::move(entry);
        nodes_.push_back(std::move(node));
    }

    auto complete = [&](const HierarchyNode& node) {
        for (std::size_t slot = 0; slot < 8; ++slot)
            if (((node.entry.childMask >> slot) & 1) && node.children[slot] < 0)
                return false;
        return true;
    };
    for (std::size_t i = before; i < nodes_.size(); ++i)
        if (nodes_[i].childrenState == ChildrenState::known && !complete(nodes_[i]))
            return undo(corrupt(say("a child of node ", nodes_[i].entry.key.text(), " is left out")));
    if (root >= 0) {
        HierarchyNode& parent = nodes_[static_cast<std::size_t>(root)];
        if (!complete(parent))
            return undo(corrupt(say("a child of node ", parent.entry.key.text(), " is left out")));
        parent.childrenState = ChildrenState::known;
    }
    return {};
}

// Walks down from `start` to the node of that key; -1 if it is not there.
std::int32_t Hierarchy::findFrom(std::int32_t start, const NodeKey& key) const {
    std::int32_t at = start;
    int level = nodes_[static_cast<std::size_t>(at)].entry.key.level;
    for (; at >= 0 && level < key.level; ++level) {
        int shift = key.level - level - 1;
        int slot = static_cast<int>(((key.x >> shift) & 1) | ((key.y >> shift) & 1) << 1 |
                                    ((key.z >> shift) & 1) << 2);
        at = nodes_[static_cast<std::size_t>(at)].children[static_cast<std::size_t>(slot)];
    }
    return at >= 0 && nodes_[static_cast<std::size_t>(at)].entry.key == key ? at : -1;
}

NodeGeometry Hierarchy::geometryOf(const NodeKey& key) const {
    const Grid& grid = metadata_->grid;
    const RootCube& cube = metadata_->rootCube;
    double side = std::ldexp(1.0, std::max(0, cube.nodeBits(key.level)));
    Vec3d min = grid.toWorld(cube.nodeMin(key));
    Vec3d size = grid.scale * side;
    NodeGeometry geometry;
    geometry.centre = min + size * 0.5;
    geometry.radius = length(size) * 0.5;
    for (int axis = 0; axis < 3; ++axis) {
        geometry.box.min[axis] = std::max(min[axis], bounds_.min[axis]);
        geometry.box.max[axis] = std::min(min[axis] + size[axis], bounds_.max[axis]);
    }
    return geometry;
}

RankDensity Hierarchy::densityOf(std::size_t index) const {
    const HierarchyNode& node = nodes_[index];
    RankDensity density = rankDensity(node.entry.key.level, spacingOf(node.entry.key), node.entry.pointCount);
    if (node.entry.childMask != 0 || node.parent < 0)
        return density;
    const NodeEntry& parent = nodes_[static_cast<std::size_t>(node.parent)].entry;
    if (parent.pointCount == 0)
        return density;
    return leafDensity(density, rankDensity(parent.key.level, spacingOf(parent.key), parent.pointCount),
                       std::popcount(parent.childMask));
}

double Hierarchy::spacingOf(const NodeKey& key) const {
    return std::ldexp(metadata_->spacing, -key.level);
}

} // namespace stipple
