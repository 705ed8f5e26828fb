// Whether two sets of points are the same multiset: every point of the one in the other exactly once, with
// every attribute equal. By comparing the points, not a hash of them.
#pragma once

#include "converter/build/counted_rows.hpp"
#include "converter/build/row_layout.hpp"
#include "shared/geometry/grid.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

struct Comparison {
    std::uint64_t filePoints = 0, inputPoints = 0, equalPoints = 0;
    // Points without an equal. Those at one position are taken as pairs whose attributes differ …
    std::uint64_t changed = 0;
    std::vector<std::uint64_t> changedPerAttribute; // … and counted for each attribute that does
    std::uint64_t missing = 0;                      // the others: in the inputs, not in the file
    std::uint64_t surplus = 0;                      // in the file, not in the inputs

    struct Difference {
        Vec3i position;
        std::string text; // one sentence
        friend bool operator<(const Difference& a, const Difference& b);
    };
    static constexpr std::size_t mostDifferences = 10;
    std::vector<Difference> first; // in Morton order

    bool same() const { return changed == 0 && missing == 0 && surplus == 0; }
    // What was found among other points, at other positions, of the same attributes.
    void add(const Comparison& other);
    // A point of the inputs, at a place where the file can have none.
    void addMissing(const Grid& grid, Vec3i position);
};

// Compares points that are few enough for memory: a set of the file's and a set of the inputs', where points
// of one position are in one set. Memory: the distinct rows of the file, and those of the inputs that the
// file lacks; about 24 bytes more for each. Thread: one.
class PointComparer {
  public:
    PointComparer(const RowLayout& layout, const Grid& grid);

    // Starts with room for so many distinct points of the file.
    void begin(std::size_t filePoints);
    // First all of the file's, then all of the inputs'.
    void addFile(const std::uint8_t* rows, std::size_t count);
    void addInput(const std::uint8_t* rows, std::size_t count);
    Comparison finish();

  private:
    struct Rest {
        const std::uint8_t* row;
        Vec3i position;
        std::uint64_t count; // equal rows
    };
    template <class Take>
    void forEachHashed(const std::uint8_t* rows, std::size_t count, const CountedRows& soon, Take take);
    std::vector<Rest> sortedRest(const CountedRows& rows) const;
    void compareRest();
    void noteChanged(const Rest& file, const Rest& input, std::uint64_t count);
    void noteSurplus(const Rest& file, std::uint64_t count);
    void noteMissing(const Rest& input, std::uint64_t count);
    void say(Vec3i position, const std::string& what, std::uint64_t count);

    const RowLayout& layout_;
    const Grid& grid_;
    CountedRows file_, missing_;
    Comparison result_;
};

} // namespace stipple
