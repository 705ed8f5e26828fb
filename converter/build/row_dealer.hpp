// Deals points into the cells of a store: what a batch has for one cell goes there as one run of rows, so
// that a cell is locked and copied to once, not once for each point.
#pragma once

#include "converter/build/row_layout.hpp"
#include "converter/build/row_store.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace stipple {

// What one thread deals with. Thread: one.
class RowDealer {
  public:
    // A cell number for points that are not dealt.
    static constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

    // For stores of `cells` cells.
    explicit RowDealer(std::size_t cells = 0) : slotOfCell_(cells, 0) {}

    // Each point of `batch` to the cell that `cellOf(position)` names; the layout must hold it.
    template <class CellOf>
    Status deal(const RowLayout& layout, const PointBatch& batch, RowStore& to, CellOf cellOf) {
        sort(batch.size(), [&](std::size_t i) { return cellOf(batch.positions[i]); });
        rows_.resize(indices_.size() * layout.rowBytes());
        layout.pack(batch, indices_, rows_.data());
        return append(to, layout.rowBytes());
    }

    // The same for `count` points that are rows already.
    template <class CellOf>
    Status deal(const RowLayout& layout, const std::uint8_t* rows, std::size_t count, RowStore& to,
                CellOf cellOf) {
        const std::size_t rowBytes = layout.rowBytes();
        sort(count, [&](std::size_t i) { return cellOf(layout.position(rows + i * rowBytes)); });
        rows_.resize(indices_.size() * rowBytes);
        for (std::size_t i = 0; i < indices_.size(); ++i)
            std::memcpy(rows_.data() + i * rowBytes, rows + indices_[i] * rowBytes, rowBytes);
        return append(to, rowBytes);
    }

  private:
    // Numbers the cells that the points meet, and sorts the points' indices by them, in their order.
    template <class CellOf>
    void sort(std::size_t count, CellOf cellOf) {
        cells_.clear();
        slotOfPoint_.resize(count);
        starts_.assign(1, 0);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t cell = cellOf(i);
            if (cell == nowhere) {
                slotOfPoint_[i] = 0;
                continue;
            }
            std::uint32_t& slot = slotOfCell_[cell];
            if (slot == 0) {
                cells_.push_back(cell);
                slot = static_cast<std::uint32_t>(cells_.size());
                starts_.push_back(0);
            }
            slotOfPoint_[i] = slot;
            ++starts_[slot];
        }
        for (std::size_t s = 1; s < starts_.size(); ++s)
            starts_[s] += starts_[s - 1];
        indices_.resize(starts_.back());
        // starts_[s] is the end of slot s, and counts down to its beginning.
        for (std::size_t i = count; i-- > 0;)
            if (slotOfPoint_[i] != 0)
                indices_[--starts_[slotOfPoint_[i]]] = static_cast<std::uint32_t>(i);
    }

    Status append(RowStore& to, std::size_t rowBytes);

    std::vector<std::uint32_t> slotOfCell_; // from 1 on; 0 between two batches
    std::vector<std::uint32_t> slotOfPoint_, starts_, indices_;
    std::vector<std::size_t> cells_; // that the batch meets
    Bytes rows_;
};

} // namespace stipple
