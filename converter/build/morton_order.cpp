#include "converter/build/morton_order.hpp"

#include "converter/build/parallel.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace stipple {

namespace {
constexpr int keyLevels = 21; // levels of the octree that a 64-bit key holds
constexpr int bucketBits = 12;
constexpr std::size_t bucketCount = std::size_t{1} << bucketBits;
constexpr std::size_t blockPoints = std::size_t{1} << 18;

struct KeyedIndex {
    std::uint64_t key;
    std::uint32_t index;
};

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

// Sorts by the key's top bits into buckets (in parallel), then each bucket by itself.
class Sorter {
  public:
    Sorter(const PointStore& store, const RootCube& cube)
        : store_(store), cube_(cube), keyShift_(std::max(0, cube.bits - keyLevels)),
          bucketShift_(std::max(0, 3 * (cube.bits - keyShift_) - bucketBits)),
          blocks_((store.size() + blockPoints - 1) / blockPoints) {}

    Result<std::vector<std::uint32_t>> run(int threads, const std::atomic<bool>* stop) {
        keyed_.resize(store_.size());
        sorted_.resize(store_.size());
        starts_.resize(blocks_);
        STIPPLE_CHECK(
            parallelFor(blocks_, threads, stop, [&](std::size_t block, int) { return key(block); }));
        layBuckets();
        STIPPLE_CHECK(
            parallelFor(blocks_, threads, stop, [&](std::size_t block, int) { return scatter(block); }));
        keyed_ = {};
        order_.resize(store_.size());
        STIPPLE_CHECK(
            parallelFor(bucketCount, threads, stop, [&](std::size_t bucket, int) { return sort(bucket); }));
        return std::move(order_);
    }

  private:
    Vec3i relative(std::uint32_t index) const { return store_.position(index) - cube_.min; }

    std::size_t blockEnd(std::size_t block) const {
        return std::min(store_.size(), (block + 1) * blockPoints);
    }

    Status key(std::size_t block) {
        std::vector<std::uint32_t>& counts = starts_[block];
        counts.assign(bucketCount, 0);
        for (std::size_t i = block * blockPoints; i < blockEnd(block); ++i) {
            Vec3i p = relative(static_cast<std::uint32_t>(i));
            std::uint64_t code = spread(static_cast<std::uint64_t>(p.x >> keyShift_)) |
                                 spread(static_cast<std::uint64_t>(p.y >> keyShift_)) << 1 |
                                 spread(static_cast<std::uint64_t>(p.z >> keyShift_)) << 2;
            keyed_[i] = {code, static_cast<std::uint32_t>(i)};
            ++counts[code >> bucketShift_];
        }
        return {};
    }

    // Turns each block's counts into where its points of each bucket go.
    void layBuckets() {
        std::uint32_t at = 0;
        for (std::size_t bucket = 0; bucket < bucketCount; ++bucket) {
            bucketStarts_[bucket] = at;
            for (std::vector<std::uint32_t>& counts : starts_) {
                std::uint32_t count = counts[bucket];
                counts[bucket] = at;
                at += count;
            }
        }
        bucketStarts_[bucketCount] = at;
    }

    Status scatter(std::size_t block) {
        std::vector<std::uint32_t>& next = starts_[block];
        for (std::size_t i = block * blockPoints; i < blockEnd(block); ++i)
            sorted_[next[keyed_[i].key >> bucketShift_]++] = keyed_[i];
        return {};
    }

    Status sort(std::size_t bucket) {
        auto begin = sorted_.begin() + bucketStarts_[bucket],
             end = sorted_.begin() + bucketStarts_[bucket + 1];
        std::sort(begin, end, [this](const KeyedIndex& a, const KeyedIndex& b) {
            return a.key != b.key ? a.key < b.key : comesBefore(a.index, b.index);
        });
        for (std::size_t i = bucketStarts_[bucket]; i < bucketStarts_[bucket + 1]; ++i)
            order_[i] = sorted_[i].index;
        return {};
    }

    // For points of one key: by what the key does not hold.
    bool comesBefore(std::uint32_t a, std::uint32_t b) const {
        if (keyShift_ > 0)
            if (int order = compareMorton(relative(a), relative(b)); order != 0)
                return order < 0;
        std::size_t attributeBytes = store_.rowBytes() - sizeof(Vec3i);
        return std::memcmp(store_.attributes(a), store_.attributes(b), attributeBytes) < 0;
    }

    const PointStore& store_;
    const RootCube cube_;
    const int keyShift_;    // low bits of the coordinates that the key leaves out
    const int bucketShift_; // low bits of the key that do not decide the bucket
    const std::size_t blocks_;
    std::vector<KeyedIndex> keyed_, sorted_;
    std::vector<std::vector<std::uint32_t>> starts_; // [block][bucket]
    std::array<std::uint32_t, bucketCount + 1> bucketStarts_{};
    std::vector<std::uint32_t> order_;
};
} // namespace

int compareMorton(Vec3i a, Vec3i b) {
    int decides = 2;
    std::uint64_t highest = static_cast<std::uint64_t>(a.z ^ b.z);
    for (int axis = 1; axis >= 0; --axis) {
        std::uint64_t difference = static_cast<std::uint64_t>(a[axis] ^ b[axis]);
        // The highest bit of `difference` is above that of `highest` (M. Connor, P. Kumar 2010, §3.1).
        if (highest < difference && highest < (highest ^ difference)) {
            decides = axis;
            highest = difference;
        }
    }
    return a[decides] < b[decides] ? -1 : a[decides] > b[decides] ? 1 : 0;
}

Result<std::vector<std::uint32_t>> mortonOrder(const PointStore& store, const RootCube& cube, int threads,
                                               const std::atomic<bool>* stop) {
    return Sorter(store, cube).run(threads, stop);
}

} // namespace stipple
