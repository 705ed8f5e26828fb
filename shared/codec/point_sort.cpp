#include "shared/codec/position_codec.hpp"
#include "shared/codec/radix_sort.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {

namespace {

std::array<std::uint32_t, 3> quantised(const KeyLayout& layout, const Vec3<std::uint32_t>& point) {
    std::array<std::uint32_t, 3> q{};
    for (std::size_t a = 0; a < 3; ++a) {
        std::uint32_t steps = point[static_cast<int>(a)] - layout.origin[a];
        q[a] = layout.step[a] == 1 ? steps : steps / layout.step[a];
    }
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
    bool sorted = true;
    std::uint64_t before = 0;
    for (KeyedIndex& point : keyed) {
        point.key = toKey(layout.pack(points[point.index]));
        sorted = sorted && before <= point.key;
        before = point.key;
    }
    if (!sorted)
        sortByKey(keyed, layout.keyBits);
}

// By the Morton code of the coordinates themselves, z before y before x.
bool isBefore(const Vec3<std::uint32_t>& a, const Vec3<std::uint32_t>& b) {
    const std::uint32_t x = a.x ^ b.x, y = a.y ^ b.y, z = a.z ^ b.z;
    auto isLower = [](std::uint32_t v, std::uint32_t w) { return v < w && v < (v ^ w); }; // the highest bit
    if (!isLower(z, y) && !isLower(z, x))
        return a.z < b.z;
    return isLower(y, x) ? a.x < b.x : a.y < b.y;
}

// In that order: points mostly come so, and then this takes no time.
std::vector<std::uint32_t> mortonOrder(std::span<const Vec3<std::uint32_t>> points) {
    std::vector<std::uint32_t> order(points.size());
    std::iota(order.begin(), order.end(), 0u);
    if (!std::is_sorted(points.begin(), points.end(), isBefore))
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return isBefore(points[a], points[b]); });
    return order;
}

// Short runs of consecutive points, by which layouts are compared: eight of them, spread evenly. Longer ones,
// or more, choose no better.
std::vector<std::vector<KeyedIndex>> sampleRuns(const std::vector<KeyedIndex>& ordered) {
    constexpr std::size_t runs = 8, runPoints = 128;
    if (ordered.size() <= runs * runPoints)
        return {ordered};
    std::vector<std::vector<KeyedIndex>> sample;
    for (std::size_t r = 0; r < runs; ++r) {
        auto from =
            ordered.begin() + static_cast<std::ptrdiff_t>((ordered.size() - runPoints) * r / (runs - 1));
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
void chooseLift(KeyLayout& layout, const Quantised& points, std::vector<std::vector<KeyedIndex>> runs) {
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
    std::vector<std::uint32_t> order = mortonOrder(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        quantisedPoints[i] = quantised(layout, points[i]);
        keyed[i].index = order[i];
    }
    chooseLift(layout, quantisedPoints, sampleRuns(keyed));
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
