// One pass over a file's points when it is opened: how many there are, where they lie, and the ranges of what
// no header states the limits of.
#pragma once

#include "converter/input/e57/attributes.hpp"

#include <atomic>
#include <functional>
#include <memory>

namespace stipple::e57 {

// What all passes know of a file.
struct Layout {
    FileHeader header;
    std::vector<ScanEntry> scans; // those that are read
    std::vector<CoordinateFields> coordinates;
    std::vector<Section> sections;
    std::optional<ExactGrid> exact;

    std::vector<const ScanEntry*> entries() const {
        std::vector<const ScanEntry*> result;
        for (const ScanEntry& scan : scans)
            result.push_back(&scan);
        return result;
    }
};

struct Measure {
    std::vector<std::vector<std::uint64_t>> points; // [scan][span]: that are kept
    ReadReport dropped;
    BoxI bounds;             // on the exact grid, where there is one
    BoxD world;              // else
    std::vector<BoxD> local; // of each scan
    MeasuredRanges ranges;
};

// Reads the coordinates, and `fields` of each scan, with so many threads, each of which opens a source of the
// file for itself. Errors: that of the first span that has one; those of `open`.
struct MeasureOptions {
    std::function<Result<std::unique_ptr<ByteSource>>()> open; // Thread: any
    int threads = 1;
    const std::atomic<bool>* stop = nullptr;
};
Result<Measure> measure(const MeasureOptions& options, const Layout& layout,
                        const std::vector<std::vector<std::size_t>>& fields);

} // namespace stipple::e57
