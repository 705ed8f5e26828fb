// The points of one node of the octree in memory, in Morton order, and the octree over them: a node's points
// are a range. The unit in which a cloud is sampled and packed.
//
// Order: by Morton code of the integers in the root cube, then by the rest of the row's bytes. So a point's
// place depends on the points alone, not on how they came in.
#pragma once

#include "converter/build/row_layout.hpp"
#include "shared/base/result.hpp"
#include "shared/codec/radix_sort.hpp"
#include "shared/geometry/node_key.hpp"

#include <array>
#include <memory>
#include <unordered_set>

namespace stipple {

// A node with more points than this is split, if it can be. Sampling moves up to about half of a leaf's
// points to its parent, so leaves end with some 10,000 to 60,000 points.
inline constexpr std::uint32_t leafCapacity = 65536;

using NodeKeys = std::unordered_set<NodeKey, NodeKeyHash>;

struct SubtreeNode {
    NodeKey key;
    std::uint32_t first = 0, count = 0;                                   // range of the points
    std::array<std::int32_t, 8> children{-1, -1, -1, -1, -1, -1, -1, -1}; // indices of nodes
    bool isLeaf = true;

    std::uint32_t end() const { return first + count; }
};

// Memory that one subtree after the other is sorted in: fresh pages cost more than the sorting.
class SubtreeBuffers {
  public:
    // Room for `count` rows, to be filled; what was in there is lost.
    std::uint8_t* rows(std::size_t count, std::size_t rowBytes);

  private:
    friend class Subtree;
    template <class T>
    struct Room {
        std::unique_ptr<T[]> items;
        std::size_t size = 0;
        T* of(std::size_t count);
    };
    Room<std::uint8_t> rows_, sorted_;
    Room<KeyedIndex> keys_, otherKeys_;
};

class Subtree {
  public:
    // Sorts the rows (fewer than 2^32, all in node `key`) that are in buffers.rows(). They came in parts of
    // `partRows` each: best such as are nodes of the octree, as those are sorted apart from each other, and
    // those that are in order already not at all. The buffers are borrowed: they outlive the subtree and
    // serve no other meanwhile. Memory: twice the rows and 32 bytes a point.
    Subtree(const RowLayout& layout, const RootCube& cube, NodeKey key, SubtreeBuffers& buffers,
            std::span<const std::size_t> partRows);

    // Splits down to leaves of at most `capacity` points …
    void splitByCount(std::uint32_t capacity);
    // … or down to nodes of these keys, which part all points.
    void splitTo(const NodeKeys& leaves);

    const RowLayout& layout() const { return *layout_; }
    const RootCube& cube() const { return cube_; }
    NodeKey key() const { return key_; }
    std::uint32_t size() const { return count_; }
    // Breadth-first; nodes()[0] is the subtree's root. None if there is no point.
    const std::vector<SubtreeNode>& nodes() const { return nodes_; }

    const std::uint8_t* rows() const { return rows_; }
    const std::uint8_t* row(std::uint32_t rank) const { return rows_ + rank * layout_->rowBytes(); }
    Vec3i position(std::uint32_t rank) const { return layout_->position(row(rank)); }

  private:
    void sort(SubtreeBuffers& buffers, std::span<const std::size_t> partRows);
    template <class MustSplit>
    void split(MustSplit mustSplit);
    void splitNode(std::size_t index);

    const RowLayout* layout_;
    RootCube cube_;
    NodeKey key_;
    const std::uint8_t* rows_ = nullptr; // sorted
    std::uint32_t count_;
    std::vector<SubtreeNode> nodes_;
};

} // namespace stipple
