#include "shared/codec/position_codec.hpp"
#include "shared/codec/radix_sort.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {

namespace {

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

using Quantised = std::vector<std::array<std::uint32_t, 3>>;

// Sorted by key only.
void sortKeys(const KeyLayout& layout, const Quantised& points, std::vector<KeyedIndex>& keyed) {
    BitPermutation toKey = keyFromPacked(layout);
    for (KeyedIndex& point : keyed)
        point.key = toKey(layout.pack(points[point.index]));
    sortByKey(keyed, layout.keyBits);
}

// Runs of consecutive points of `sorted`, 8192 points at most, by which layouts are compared. A run is
// long enough to span many points along each axis.
std::vector<std::vector<KeyedIndex>> sampleRuns(const std::vector<KeyedIndex>& sorted) {
    constexpr std::size_t runs = 4, runPoints = 2048;
    if (sorted.size() <= runs * runPoints)
        return {sorted};
    std::vector<std::vector<KeyedIndex>> sample;
    for (std::size_t r = 0; r < runs; ++r) {
        auto from =
            sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - runPoints) * r / (runs - 1));
        sample.emplace_back(from, from + static_cast<std::ptrdiff_t>(runPoints));
    }
    return sample;
}

// What the differences of the runs' keys take, in 1/16 bits, as integers: the choice must not depend on
// how a machine computes a logarithm.
std::uint64_t keyCost(const KeyLayout& layout, const Quantised& points,
                      std::vector<std::vector<KeyedIndex>>& runs) {
    std::uint64_t cost = 0;
    for (auto& run : runs) {
        sortKeys(layout, points, run);
        for (std::size_t i = 1; i < run.size(); ++i) {
            std::uint64_t difference = run[i].key - run[i - 1].key + 1;
            int length = bitLength(difference);
            // log2 by its integer part and, between powers of two, a straight line.
            std::uint64_t fraction = length > 4 ? difference >> (length - 5) : difference << (5 - length);
            cost += 16 * static_cast<std::uint64_t>(length) + fraction;
        }
    }
    return cost;
}

// Raises one axis for as long as that makes the keys' differences smaller.
void chooseLift(KeyLayout& layout, const Quantised& points, const std::vector<KeyedIndex>& sorted) {
    auto runs = sampleRuns(sorted);
    std::uint64_t best = keyCost(layout, points, runs);
    KeyLayout chosen = layout;
    for (std::size_t axis : {2u, 1u, 0u}) {
        KeyLayout tried = layout;
        for (int lift = 1; lift <= maxLift; ++lift) {
            tried.lift[axis] = static_cast<std::uint8_t>(lift);
            tried.complete();
            std::uint64_t cost = keyCost(tried, points, runs);
            if (cost >= best)
                break;
            best = cost;
            chosen = tried;
        }
        if (chosen.lift[axis] > 0) // the axis a surface is flat along; the others would not gain
            break;
    }
    layout = chosen;
}

} // namespace

SortedPoints sortPoints(std::span<const Vec3<std::uint32_t>> points) {
    SortedPoints sorted;
    sorted.layout = fitLayout(points);
    KeyLayout& layout = sorted.layout;
    Quantised quantisedPoints(points.size());
    std::vector<KeyedIndex> keyed(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        quantisedPoints[i] = quantised(layout, points[i]);
        keyed[i].index = static_cast<std::uint32_t>(i);
    }
    sortKeys(layout, quantisedPoints, keyed);
    chooseLift(layout, quantisedPoints, keyed);
    if (layout.lift != decltype(layout.lift){})
        sortKeys(layout, quantisedPoints, keyed);
    auto lowOf = [&](const KeyedIndex& point) { return packLows(layout, quantisedPoints[point.index]); };
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
    for (const KeyedIndex& point : keyed) {
        sorted.keys.push_back(point.key);
        sorted.input.push_back(point.index);
        if (layout.lowBits > 0)
            sorted.lows.push_back(lowOf(point));
    }
    return sorted;
}

} // namespace stipple
