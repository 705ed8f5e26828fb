// A multiset of points as rows: each distinct row once, with how often it is there. So any number of equal
// points takes the room of one.
#pragma once

#include "shared/base/bytes.hpp"

#include <cstdint>
#include <vector>

namespace stipple {

// A hash table with linear probing. Memory: a row and, on average, 24 bytes for each distinct row; throws
// std::bad_alloc. Thread: one.
class CountedRows {
  public:
    explicit CountedRows(std::size_t rowBytes);
    // Empties it, with room for so many distinct rows.
    void clear(std::size_t rows);

    static std::uint32_t hashOf(const std::uint8_t* row, std::size_t rowBytes);

    // `hash` is the row's.
    void add(const std::uint8_t* row, std::uint32_t hash);
    // Removes one of the rows that are equal to this one; false if there is none.
    bool take(const std::uint8_t* row, std::uint32_t hash);
    // Says that a row of this hash will be asked for soon.
    void prefetch(std::uint32_t hash) const { __builtin_prefetch(&slots_[hash & mask_]); }

    // Calls visit(row, count) for every distinct row that is there. Rows stay where they are until the next
    // add() or clear().
    template <class Visit>
    void forEach(Visit visit) const {
        for (const Slot& slot : slots_)
            if (slot.row != none && slot.count > 0)
                visit(rowAt(slot.row), slot.count);
    }

  private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Slot {
        std::uint32_t hash = 0, row = none; // number of the row
        std::uint64_t count = 0;
    };

    const std::uint8_t* rowAt(std::uint32_t row) const { return rows_.data() + row * rowBytes_; }
    // The slot of an equal row, or the empty one where it would go.
    Slot& find(const std::uint8_t* row, std::uint32_t hash);
    void grow(std::size_t slots);

    std::size_t rowBytes_;
    std::vector<Slot> slots_; // 2^n of them, at most 5/8 taken
    std::uint32_t mask_ = 0;
    std::size_t taken_ = 0;
    Bytes rows_;
};

} // namespace stipple
