// Grid and random sampling (chooser.hpp). Both count the cells of a node that hold points. A node's side is a
// whole number of cells, so cells do not cross borders and nodes need not know of each other.
#pragma once

#include "converter/build/chooser.hpp"

namespace stipple {

// The cells of a node of 2^nodeBits steps: per axis as many, and at least one, as give cells nearest to the
// minimum distance in width; one along an axis without weight.
class SampleGrid {
  public:
    SampleGrid(const Spacing& spacing, int nodeBits);

    Vec3i count() const { return count_; } // of cells per axis
    // Exact. `p` in steps from the node's corner.
    Vec3i cellOf(Vec3<std::uint32_t> p) const;
    std::uint64_t indexOf(Vec3i cell) const;
    // Of `p` from the cell's centre, squared, in a unit of the grid's own. Exact where the axes' scales are
    // equal and the node is at most 2^25 steps wide.
    double squaredToCentre(Vec3<std::uint32_t> p, Vec3i cell) const;

  private:
    int nodeBits_ = 0;
    Vec3i count_{1, 1, 1};
    Vec3d unit_{1, 1, 1}; // see squaredToCentre()
};

// One entry for each cell that was asked for; keeps its memory from use to use.
class CellTable {
  public:
    struct Entry {
        std::uint64_t cell;
        std::uint32_t point;
        double squared;
    };
    void begin(std::size_t mostCells);
    // The index of the cell's entry, and whether it is new (`point` and `squared` are then to be set).
    std::pair<std::uint32_t, bool> find(std::uint64_t cell);
    Entry& operator[](std::uint32_t index) { return entries_[index]; }
    const std::vector<Entry>& entries() const { return entries_; }

  private:
    std::vector<std::uint32_t> slots_; // index of the entry + 1, or 0
    std::vector<Entry> entries_;
};

class CellChooser : public Chooser {
  public:
    CellChooser(const Subtree& subtree, const Spacing& spacing, int workers);

    bool heedsNeighbours() const override { return false; }
    void finishLevel(std::size_t, std::size_t) override {}
    Borders takeBorders() override { return {}; }

  protected:
    const NodeKey& key(const Candidates& candidates) const { return subtree_.nodes()[candidates.node].key; }
    // For each cell that holds candidates the one nearest to its centre, the first in Morton order if several
    // are. Sets for each candidate which entry its cell has.
    const std::vector<CellTable::Entry>& nearestToCentres(const Candidates& candidates, int worker,
                                                          std::span<std::uint32_t> entries);

    const Subtree& subtree_;

  private:
    const Spacing& spacing_;
    std::vector<CellTable> tables_; // one for each worker
};

class GridChooser : public CellChooser {
  public:
    using CellChooser::CellChooser;
    void choose(const Candidates& candidates, int worker, std::span<std::uint32_t> representatives) override;
};

// Points have a hash for each level, so that what is chosen on one says nothing of the next.
class RandomChooser : public CellChooser {
  public:
    using CellChooser::CellChooser;
    void choose(const Candidates& candidates, int worker, std::span<std::uint32_t> representatives) override;

  private:
    std::uint64_t hashOf(std::uint32_t rank, int level) const;
};

} // namespace stipple
