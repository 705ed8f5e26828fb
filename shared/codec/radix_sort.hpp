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

// Sorts by `bits` bits of the key from bit `lowest` on; there are fewer than 2^32 items.
inline void radixSort(std::vector<KeyedIndex>& items, int bits, int lowest = 0) {
    constexpr int digitBits = 11;
    constexpr std::size_t digits = std::size_t{1} << digitBits;
    std::vector<KeyedIndex> other(items.size());
    for (int shift = lowest; shift < lowest + bits; shift += digitBits) {
        auto digit = [shift](const KeyedIndex& item) {
            return static_cast<std::size_t>(item.key >> shift) & (digits - 1);
        };
        std::array<std::uint32_t, digits> start{};
        for (const KeyedIndex& item : items)
            ++start[digit(item)];
        std::uint32_t sum = 0;
        for (std::uint32_t& count : start)
            sum += std::exchange(count, sum);
        for (const KeyedIndex& item : items)
            other[start[digit(item)]++] = item;
        items.swap(other);
    }
}

} // namespace stipple
