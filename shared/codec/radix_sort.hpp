// Least-significant-digit radix sort of 64-bit keys that carry an index. Stable; time is linear.
#pragma once

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

// Sorts by the low `bits` bits of the key.
inline void radixSort(std::vector<KeyedIndex>& items, int bits) {
    std::vector<KeyedIndex> other(items.size());
    if (radixSort(items.data(), other.data(), items.size(), bits, 0) != items.data())
        items.swap(other);
}

} // namespace stipple
