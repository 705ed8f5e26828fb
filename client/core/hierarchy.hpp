// The nodes of one cloud that are known so far: a tree that grows piece by piece as hierarchy chunks
// arrive. Indices are stable; parents come before their children.
//
// add() trusts nothing: a chunk that repeats a node, brings one that no parent announced, leaves out one that
// was announced, or holds more points than the cloud, is refused as a whole. So a chunk that names itself or
// one above it ends in an error, not in a circle.
#pragma once

#include "client/core/rank_density.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/node_entry.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace stipple {

inline constexpr std::size_t maxKnownNodes = 16'000'000; // of one cloud

enum class ChildrenState : std::uint8_t {
    known,   // `children` is final (there may be none)
    missing, // in a chunk that has not arrived
    failed,  // in a chunk that can't be had
};

// Where a node is, world units.
struct NodeGeometry {
    BoxD box; // of the points it or its descendants can hold: its cube within the cloud's bounds
    Vec3d centre;
    double radius = 0; // of the cube's circumscribed sphere around `centre`
};

struct HierarchyNode {
    NodeEntry entry;
    NodeGeometry geometry;
    std::int32_t parent = -1;
    ChildrenState childrenState = ChildrenState::known;
    std::array<std::int32_t, 8> children{-1, -1, -1, -1, -1, -1, -1, -1}; // -1: none, or not known yet
};

class Hierarchy {
  public:
    Hierarchy() = default;
    // unsupported or corrupt: a grid that positions can't be computed with.
    static Result<Hierarchy> create(std::shared_ptr<const CloudMetadata> metadata,
                                    std::vector<NodeEntry> rootNodes);

    // The chunk with the children of node `parent`, whose children must be missing. After an error the
    // hierarchy is as it was.
    Status add(std::size_t parent, std::vector<NodeEntry> nodes);
    void markChildrenFailed(std::size_t parent);
    void markChildrenMissing(std::size_t parent); // they can be had again

    std::size_t size() const { return nodes_.size(); }
    // Index of the node of that key; -1 if it is not known.
    std::int32_t find(const NodeKey& key) const { return nodes_.empty() ? -1 : findFrom(0, key); }
    const HierarchyNode& node(std::size_t index) const { return nodes_[index]; }
    const CloudMetadata& metadata() const { return *metadata_; }
    // Geometry of any node, known or not.
    NodeGeometry geometryOf(const NodeKey& key) const;
    // Minimum distance of a node's points, world units.
    double spacingOf(const NodeKey& key) const;
    // Of a node's points by rank; `index` must have points.
    RankDensity densityOf(std::size_t index) const;

  private:
    Status append(std::int32_t root, std::vector<NodeEntry> nodes);
    std::int32_t findFrom(std::int32_t start, const NodeKey& key) const;

    std::shared_ptr<const CloudMetadata> metadata_;
    BoxD bounds_;
    std::vector<HierarchyNode> nodes_;
    std::uint64_t points_ = 0;
};

} // namespace stipple
