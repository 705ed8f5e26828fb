#include "shared/codec/position_codec.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {

namespace {

struct KeyedPoint {
    std::uint64_t key;
    std::uint32_t input;
};

// Radix sort by the low `bits` bits of the key, stable.
void sortByKey(std::vector<KeyedPoint>& points, int bits) {
    constexpr int digitBits = 11;
    constexpr std::size_t digits = std::size_t{1} << digitBits;
    std::vector<KeyedPoint> other(points.size());
    for (int shift = 0; shift < bits; shift += digitBits) {
        std::array<std::uint32_t, digits> start{};
        for (const KeyedPoint& point : points)
            ++start[(point.key >> shift) & (digits - 1)];
        std::uint32_t sum = 0;
        for (std::uint32_t& count : start)
            sum += std::exchange(count, sum);
        for (const KeyedPoint& point : points)
            other[start[(point.key >> shift) & (digits - 1)]++] = point;
        points.swap(other);
    }
}

std::array<std::uint32_t, 3> quantised(const KeyLayout& layout, const Vec3<std::uint32_t>& point) {
    std::array<std::uint32_t, 3> q{};
    for (std::size_t a = 0; a < 3; ++a)
        q[a] = (point[static_cast<int>(a)] - layout.origin[a]) / layout.step[a];
    return q;
}

std::uint64_t packLows(const KeyLayout& layout, std::array<std::uint32_t, 3> q) {
    std::uint64_t low = 0;
    int at = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        low |= (std::uint64_t{q[a]} & ((std::uint64_t{1} << layout.lowBitsOf[a]) - 1)) << at;
        at += layout.lowBitsOf[a];
    }
    return low;
}

} // namespace

SortedPoints sortPoints(std::span<const Vec3<std::uint32_t>> points) {
    SortedPoints sorted;
    sorted.layout = fitLayout(points);
    const KeyLayout& layout = sorted.layout;
    BitPermutation toKey = keyFromPacked(layout);
    std::vector<KeyedPoint> keyed(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        keyed[i] = {toKey(layout.pack(quantised(layout, points[i]))), static_cast<std::uint32_t>(i)};
    auto lowOf = [&](const KeyedPoint& point) {
        return packLows(layout, quantised(layout, points[point.input]));
    };
    sortByKey(keyed, layout.keyBits);
    if (layout.lowBits > 0)
        for (std::size_t i = 0, end = 0; i < keyed.size(); i = end) {
            while (end < keyed.size() && keyed[end].key == keyed[i].key)
                ++end;
            std::stable_sort(keyed.begin() + static_cast<std::ptrdiff_t>(i),
                             keyed.begin() + static_cast<std::ptrdiff_t>(end),
                             [&](auto& a, auto& b) { return lowOf(a) < lowOf(b); });
        }
    sorted.keys.reserve(points.size());
    sorted.input.reserve(points.size());
    for (const KeyedPoint& point : keyed) {
        sorted.keys.push_back(point.key);
        sorted.input.push_back(point.input);
        if (layout.lowBits > 0)
            sorted.lows.push_back(lowOf(point));
    }
    return sorted;
}

} // namespace stipple
