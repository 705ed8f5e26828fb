#include "shared/format/hierarchy_layout.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {

// A tree of up to this many nodes is one chunk; a larger one is cut so that a chunk and those below it
// are of like size, at most this.
constexpr std::uint64_t chunkNodes = 1024;
constexpr std::uint64_t leastChunkNodes = 64;
// Subtrees of up to this many nodes stay with their parent: a chunk of their own would cost more.
constexpr std::uint64_t smallSubtree = 16;

bool mortonBefore(const NodeKey& a, const NodeKey& b) {
    if (a.level != b.level)
        return a.level < b.level;
    std::uint32_t x = a.x ^ b.x, y = a.y ^ b.y, z = a.z ^ b.z;
    // The axis whose difference has the highest bit decides; z before y before x where they are equal.
    auto lower = [](std::uint32_t p, std::uint32_t q) { return p < q && p < (p ^ q); };
    if (!lower(z, x) && !lower(z, y))
        return a.z < b.z;
    return lower(y, x) ? a.x < b.x : a.y < b.y;
}

template <class Visit>
void forEachChild(const OctreeNode& node, const Visit& visit) {
    for (int c = 0; c < std::popcount(node.childMask); ++c)
        visit(node.firstChild + static_cast<std::size_t>(c));
}

// How many levels below `top` a chunk expands whole, so that it has at most `limit` nodes.
int wholeLevels(const std::vector<OctreeNode>& nodes, const std::vector<std::size_t>& top,
                std::uint64_t limit) {
    std::vector<std::size_t> level = top, next;
    std::uint64_t total = level.size();
    for (int depth = 0;; ++depth) {
        next.clear();
        for (std::size_t i : level)
            forEachChild(nodes[i], [&](std::size_t child) { next.push_back(child); });
        total += next.size();
        if (next.empty() || total > limit)
            return depth;
        level.swap(next);
    }
}

ChunkPlan planChunk(std::vector<OctreeNode>& nodes, std::ptrdiff_t parent, std::vector<std::size_t> top) {
    std::uint64_t total = 0;
    for (std::size_t i : top)
        total += 1 + nodes[i].descendants;
    auto balanced = static_cast<std::uint64_t>(std::sqrt(static_cast<double>(total)));
    std::uint64_t limit = total <= chunkNodes ? total : std::clamp(balanced, leastChunkNodes, chunkNodes);
    int levels = wholeLevels(nodes, top, limit);
    int topLevel = nodes[top[0]].key.level;

    ChunkPlan plan{parent, std::move(top), 0};
    for (std::size_t at = 0; at < plan.nodes.size(); ++at) {
        OctreeNode& node = nodes[plan.nodes[at]];
        bool expands = node.key.level < topLevel + levels ||
                       (node.descendants <= smallSubtree && plan.nodes.size() < 2 * chunkNodes);
        if (expands)
            forEachChild(node, [&](std::size_t child) { plan.nodes.push_back(child); });
        node.childrenElsewhere = !expands && node.childMask != 0;
    }
    return plan;
}

} // namespace

std::vector<OctreeNode> completeOctree(const std::vector<NodeKey>& keys) {
    std::vector<OctreeNode> nodes;
    nodes.reserve(keys.size() + 1);
    for (std::size_t i = 0; i < keys.size(); ++i)
        nodes.push_back({keys[i], 0, false, 0, 0, static_cast<std::ptrdiff_t>(i)});
    auto before = [](const OctreeNode& a, const OctreeNode& b) { return mortonBefore(a.key, b.key); };
    std::sort(nodes.begin(), nodes.end(), before);
    if (nodes.empty() || nodes[0].key.level > 0)
        nodes.insert(nodes.begin(), OctreeNode{});

    // From the deepest level up: each level's parents are merged into the level above.
    std::vector<OctreeNode> below, done;
    int level = nodes.back().key.level;
    for (auto end = nodes.end(); level >= 0; --level) {
        auto begin =
            std::find_if(nodes.begin(), end, [&](const OctreeNode& n) { return n.key.level == level; });
        std::vector<OctreeNode> own(begin, end), merged;
        end = begin;
        std::size_t at = 0;
        for (std::size_t i = 0; i < below.size();) {
            NodeKey parent = below[i].key.parent();
            while (at < own.size() && mortonBefore(own[at].key, parent))
                merged.push_back(own[at++]);
            if (at < own.size() && own[at].key == parent)
                merged.push_back(own[at++]);
            else
                merged.push_back({parent, 0, false, 0, 0, -1});
            for (; i < below.size() && below[i].key.parent() == parent; ++i) {
                merged.back().childMask |= static_cast<std::uint8_t>(1 << below[i].key.indexInParent());
                merged.back().descendants += 1 + below[i].descendants;
            }
        }
        merged.insert(merged.end(), own.begin() + static_cast<std::ptrdiff_t>(at), own.end());
        done.insert(done.end(), merged.rbegin(), merged.rend());
        below = std::move(merged);
    }
    std::reverse(done.begin(), done.end());
    std::size_t next = 1;
    for (OctreeNode& node : done) {
        node.firstChild = next;
        next += static_cast<std::size_t>(std::popcount(node.childMask));
    }
    return done;
}

std::vector<ChunkPlan> planChunks(std::vector<OctreeNode>& nodes) {
    std::vector<ChunkPlan> chunks;
    chunks.push_back(planChunk(nodes, -1, {0}));
    for (std::size_t c = 0; c < chunks.size(); ++c) {
        chunks[c].firstChildChunk = chunks.size();
        for (std::size_t at = 0; at < chunks[c].nodes.size(); ++at) {
            std::size_t i = chunks[c].nodes[at];
            if (!nodes[i].childrenElsewhere)
                continue;
            std::vector<std::size_t> top;
            forEachChild(nodes[i], [&](std::size_t child) { top.push_back(child); });
            chunks.push_back(planChunk(nodes, static_cast<std::ptrdiff_t>(i), std::move(top)));
        }
    }
    return chunks;
}

} // namespace stipple
