// Least-significant-digit radix sort of 64-bit keys that carry an index. Stable; time is linear.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace stipple {

struct KeyedIndex {
    std::uint64_t key;
    std::uint32_t index;
};

// Sorts `count` items by `bits` bits of the key from bit `lowest` on, with as many items of room in `other`;
// there are fewer than 2^32. Returns where the sorted items are: one of the two.
inline KeyedIndex* radixSort(KeyedIndex* items, KeyedIndex* other, std::size_t count, int bits, int lowest) {
    constexpr int digitBits = 11;
    constexpr std::size_t digits = std::size_t{1} << digitBits;
    for (int shift = lowest; shift < lowest + bits; shift += digitBits) {
        auto digit = [shift](const KeyedIndex& item) {
            return static_cast<std::size_t>(item.key >> shift) & (digits - 1);
        };
        std::array<std::uint32_t, digits> start{};
        for (std::size_t i = 0; i < count; ++i)
            ++start[digit(items[i])];
        std::uint32_t sum = 0;
        for (std::uint32_t& number : start)
            sum += std::exchange(number, sum);
        for (std::size_t i = 0; i < count; ++i)
            other[start[digit(items[i])]++] = items[i];
        std::swap(items, other);
    }
    return items;
}

// Sorts by the low `bits` bits of the key; items of equal keys keep the order of their indices. Most keys are
// told apart by their upper bits: only those are sorted by radix, and the short runs that share them by
// comparison.
inline KeyedIndex* sortByKey(KeyedIndex* items, KeyedIndex* other, std::size_t count, int bits) {
    int radixBits = 11;
    while (radixBits < bits && count >> (radixBits - 6) > 0) // 64 times more values than items
        radixBits += 11;
    const int shift = bits > radixBits ? bits - radixBits : 0;
    items = radixSort(items, other, count, bits - shift, shift);
    for (std::size_t i = 0, end = 0; shift > 0 && i < count; i = end) {
        for (end = i + 1; end < count && items[end].key >> shift == items[i].key >> shift;)
            ++end;
        if (end - i > 1)
            std::sort(items + i, items + end, [](const KeyedIndex& a, const KeyedIndex& b) {
                return a.key != b.key ? a.key < b.key : a.index < b.index;
            });
    }
    return items;
}

inline void sortByKey(std::vector<KeyedIndex>& items, int bits) {
    std::vector<KeyedIndex> other(items.size());
    if (sortByKey(items.data(), other.data(), items.size(), bits) != items.data())
        items.swap(other);
}

} // namespace stipple
