#include "converter/build/counted_rows.hpp"

#include "shared/codec/checksum.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <new>

namespace stipple {

namespace {
constexpr std::size_t fewestSlots = 1024;
}

CountedRows::CountedRows(std::size_t rowBytes) : rowBytes_(rowBytes) {
    clear(0);
}

std::uint32_t CountedRows::hashOf(const std::uint8_t* row, std::size_t rowBytes) {
    return static_cast<std::uint32_t>(xxh64(ByteSpan(row, rowBytes)));
}

CountedRows::Slot& CountedRows::find(const std::uint8_t* row, std::uint32_t hash) {
    for (std::uint32_t at = hash & mask_;; at = (at + 1) & mask_) {
        Slot& slot = slots_[at];
        if (slot.row == none || (slot.hash == hash && std::memcmp(rowAt(slot.row), row, rowBytes_) == 0))
            return slot;
    }
}

void CountedRows::add(const std::uint8_t* row, std::uint32_t hash) {
    Slot* slot = &find(row, hash);
    if (slot->row == none) {
        if (8 * (taken_ + 1) > 5 * slots_.size()) {
            grow(2 * slots_.size());
            slot = &find(row, hash);
        }
        slot->hash = hash;
        slot->row = static_cast<std::uint32_t>(taken_++);
        rows_.insert(rows_.end(), row, row + rowBytes_);
    }
    ++slot->count;
}

bool CountedRows::take(const std::uint8_t* row, std::uint32_t hash) {
    Slot& slot = find(row, hash);
    if (slot.row == none || slot.count == 0)
        return false;
    --slot.count;
    return true;
}

void CountedRows::grow(std::size_t count) {
    if (count > std::size_t{1} << 31)
        throw std::bad_alloc(); // beyond what rows are numbered with
    std::vector<Slot> old(count);
    old.swap(slots_);
    mask_ = static_cast<std::uint32_t>(count - 1);
    for (const Slot& slot : old) {
        if (slot.row == none)
            continue;
        std::uint32_t at = slot.hash & mask_;
        while (slots_[at].row != none)
            at = (at + 1) & mask_;
        slots_[at] = slot;
    }
}

void CountedRows::clear(std::size_t rows) {
    taken_ = 0;
    rows_.clear();
    rows_.reserve(rows * rowBytes_);
    const std::size_t count = std::max(fewestSlots, std::bit_ceil(rows * 8 / 5 + 1));
    if (count == slots_.size()) {
        std::fill(slots_.begin(), slots_.end(), Slot{});
    } else {
        slots_ = {}; // before the new ones, not beside them
        grow(count);
    }
}

} // namespace stipple
