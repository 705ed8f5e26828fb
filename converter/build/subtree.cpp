#include "converter/build/subtree.hpp"

#include "converter/build/morton.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

namespace stipple {

namespace {
constexpr int keyLevels = 21;        // levels of the octree that a 64-bit key holds
constexpr std::size_t fewRows = 512; // that radix sorting is not worth its tables for
constexpr int sortedBits = 33;       // of the key, by radix: three passes; few points share them

// The lower 21 bits of `value`, two zero bits between them.
std::uint64_t spread(std::uint64_t value) {
    value &= 0x1FFFFF;
    value = (value | value << 32) & 0x1F00000000FFFF;
    value = (value | value << 16) & 0x1F0000FF0000FF;
    value = (value | value << 8) & 0x100F00F00F00F00F;
    value = (value | value << 4) & 0x10C30C30C30C30C3;
    value = (value | value << 2) & 0x1249249249249249;
    return value;
}

std::uint64_t mortonKey(Vec3i p, int shift) {
    return spread(static_cast<std::uint64_t>(p.x >> shift)) |
           spread(static_cast<std::uint64_t>(p.y >> shift)) << 1 |
           spread(static_cast<std::uint64_t>(p.z >> shift)) << 2;
}

// Which child of a node of `level` holds `p`.
int childIndex(const RootCube& cube, int level, Vec3i p) {
    int shift = cube.nodeBits(level) - 1;
    return static_cast<int>(((p.x - cube.min.x) >> shift & 1) | ((p.y - cube.min.y) >> shift & 1) << 1 |
                            ((p.z - cube.min.z) >> shift & 1) << 2);
}

// Sorts rows by key, then by what the key does not hold.
class RowSorter {
  public:
    RowSorter(const RowLayout& layout, const RootCube& cube, NodeKey key, const std::uint8_t* rows,
              KeyedIndex* items, KeyedIndex* other, std::size_t count)
        : layout_(layout), corner_(cube.nodeMin(key)), bits_(cube.nodeBits(key.level)),
          lowBits_(std::max(0, bits_ - keyLevels)), rows_(rows), items_(items), other_(other), count_(count) {
    }

    // The rows came in parts of so many; see Subtree.
    const KeyedIndex* sort(std::span<const std::size_t> partRows) {
        for (std::size_t i = 0; i < count_; ++i)
            items_[i] = {mortonKey(relative(i), lowBits_), static_cast<std::uint32_t>(i)};
        std::vector<Part> parts;
        std::size_t end = 0;
        for (std::size_t rows : partRows) {
            std::size_t begin = std::exchange(end, std::min(end + rows, count_));
            if (end > begin)
                parts.push_back({begin, end});
        }
        if (end < count_)
            parts.push_back({end, count_});
        for (const Part& part : parts)
            sortPart(part);
        if (!concatenate(parts))
            sortPart({0, count_});
        return items_;
    }

  private:
    const std::uint8_t* row(std::size_t index) const { return rows_ + index * layout_.rowBytes(); }
    Vec3i relative(std::size_t index) const { return layout_.position(row(index)) - corner_; }

    struct Part {
        std::size_t begin, end;
    };

    void sortPart(Part part) {
        KeyedIndex *items = items_ + part.begin, *other = other_ + part.begin;
        const std::size_t count = part.end - part.begin;
        if (count < fewRows)
            return sortRun(part.begin, part.end);
        std::uint64_t differing = 0;
        bool isSorted = true;
        for (std::size_t i = 1; i < count; ++i) {
            differing |= items[i].key ^ items[0].key;
            isSorted = isSorted && items[i - 1].key <= items[i].key;
        }
        const int differingBits = static_cast<int>(std::bit_width(differing));
        const int shift = isSorted ? 0 : std::max(0, differingBits - sortedBits);
        if (!isSorted && radixSort(items, other, count, differingBits - shift, shift) == other)
            std::memcpy(items, other, count * sizeof(KeyedIndex));
        for (std::size_t i = part.begin, end = 0; i < part.end; i = end) {
            for (end = i + 1; end < part.end && items_[end].key >> shift == items_[i].key >> shift;)
                ++end;
            if (end - i > 1)
                sortRun(i, end);
        }
    }

    // Puts sorted parts one after the other. False if they overlap.
    bool concatenate(std::vector<Part>& parts) {
        auto isBefore = [this](const Part& a, const Part& b) {
            return items_[a.begin].key < items_[b.begin].key;
        };
        const bool inOrder = std::is_sorted(parts.begin(), parts.end(), isBefore);
        std::sort(parts.begin(), parts.end(), isBefore);
        for (std::size_t i = 1; i < parts.size(); ++i)
            if (items_[parts[i - 1].end - 1].key >= items_[parts[i].begin].key)
                return false;
        if (inOrder)
            return true;
        KeyedIndex* to = other_;
        for (const Part& part : parts)
            to = std::copy(items_ + part.begin, items_ + part.end, to);
        std::swap(items_, other_);
        return true;
    }

    void sortRun(std::size_t begin, std::size_t end) {
        std::sort(items_ + begin, items_ + end, [this](const KeyedIndex& a, const KeyedIndex& b) {
            return a.key != b.key ? a.key < b.key : comesBefore(a.index, b.index);
        });
    }

    bool comesBefore(std::uint32_t a, std::uint32_t b) const {
        if (lowBits_ > 0)
            if (int order = compareMorton(relative(a), relative(b)); order != 0)
                return order < 0;
        return std::memcmp(layout_.attributes(row(a)), layout_.attributes(row(b)),
                           layout_.attributeBytes() + layout_.extraBytes()) < 0;
    }

    const RowLayout& layout_;
    const Vec3i corner_;
    const int bits_, lowBits_; // of coordinates in the node; those that keys leave out
    const std::uint8_t* rows_;
    KeyedIndex *items_, *other_;
    const std::size_t count_;
};
} // namespace

namespace {
// A call to memcpy costs more than a row.
void copyRow(std::uint8_t* to, const std::uint8_t* from, std::size_t bytes) {
    constexpr std::size_t step = 16;
    if (bytes < step) {
        std::memcpy(to, from, bytes);
        return;
    }
    for (std::size_t at = 0; at + step <= bytes; at += step)
        std::memcpy(to + at, from + at, step);
    std::memcpy(to + bytes - step, from + bytes - step, step);
}
} // namespace

std::uint8_t* SubtreeBuffers::rows(std::size_t count, std::size_t rowBytes) {
    return rows_.of(count * rowBytes);
}

template <class T>
T* SubtreeBuffers::Room<T>::of(std::size_t count) {
    if (size < count) {
        items.reset(); // before the larger one, not beside it
        items = std::make_unique_for_overwrite<T[]>(count);
        size = count;
    }
    return items.get();
}

Subtree::Subtree(const RowLayout& layout, const RootCube& cube, NodeKey key, SubtreeBuffers& buffers,
                 std::span<const std::size_t> partRows)
    : layout_(&layout), cube_(cube), key_(key),
      count_(static_cast<std::uint32_t>(std::accumulate(partRows.begin(), partRows.end(), std::size_t{0}))) {
    sort(buffers, partRows);
}

void Subtree::sort(SubtreeBuffers& buffers, std::span<const std::size_t> partRows) {
    constexpr std::size_t ahead = 24;
    const std::uint8_t* rows = buffers.rows_.items.get();
    RowSorter sorter(*layout_, cube_, key_, rows, buffers.keys_.of(count_), buffers.otherKeys_.of(count_),
                     count_);
    const KeyedIndex* items = sorter.sort(partRows);
    rows_ = rows;
    bool inPlace = true;
    for (std::size_t i = 0; i < count_ && inPlace; ++i)
        inPlace = items[i].index == i;
    if (inPlace)
        return;
    const std::size_t rowBytes = layout_->rowBytes();
    std::uint8_t* sorted = buffers.sorted_.of(count_ * rowBytes);
    for (std::size_t i = 0; i < count_; ++i) {
        __builtin_prefetch(rows + items[std::min<std::size_t>(i + ahead, count_ - 1)].index * rowBytes);
        copyRow(sorted + i * rowBytes, rows + items[i].index * rowBytes, rowBytes);
    }
    rows_ = sorted;
}

void Subtree::splitByCount(std::uint32_t capacity) {
    split([&](const SubtreeNode& node) {
        if (cube_.nodeBits(node.key.level) > maxNodeBits)
            return true; // too wide to hold points
        if (node.count <= capacity || node.key.level >= std::min(cube_.bits, maxLevel))
            return false;
        // The first and the last in Morton order are the same: all are, and no cut separates them.
        return position(node.first) != position(node.end() - 1);
    });
}

void Subtree::splitTo(const NodeKeys& leaves) {
    split([&](const SubtreeNode& node) { return !leaves.contains(node.key); });
}

template <class MustSplit>
void Subtree::split(MustSplit mustSplit) {
    nodes_.clear();
    if (count_ == 0)
        return;
    SubtreeNode root;
    root.key = key_;
    root.count = count_;
    nodes_.push_back(root);
    for (std::size_t i = 0; i < nodes_.size(); ++i)
        if (mustSplit(nodes_[i]))
            splitNode(i);
}

void Subtree::splitNode(std::size_t index) {
    SubtreeNode node = nodes_[index];
    node.isLeaf = false;
    std::uint32_t at = node.first;
    for (int child = 0; child < 8; ++child) {
        // The order has child 0's points first, then child 1's …
        std::uint32_t begin = at, end = node.end();
        while (begin < end) {
            std::uint32_t middle = begin + (end - begin) / 2;
            if (childIndex(cube_, node.key.level, position(middle)) <= child)
                begin = middle + 1;
            else
                end = middle;
        }
        if (begin > at) {
            node.children[static_cast<std::size_t>(child)] = static_cast<std::int32_t>(nodes_.size());
            SubtreeNode below;
            below.key = node.key.child(child);
            below.first = at;
            below.count = begin - at;
            nodes_.push_back(below);
        }
        at = begin;
    }
    nodes_[index] = node;
}

} // namespace stipple
