// A file's points against those of the scans it was made of, in bounded memory.
//
// The file is an index already: what lies in an octree node of some level is in the nodes below it and in its
// few ancestors. So only the inputs are dealt into cells (which are octree nodes; tile.hpp), and the points
// of the file's nodes above; then the cells are compared one by one, reading the nodes below each. What does
// not fit memory meanwhile goes to a scratch file. A cell of too many points is parted by a hash of
// positions.
#pragma once

#include "converter/build/compare.hpp"
#include "converter/build/convert.hpp"
#include "converter/build/point_sums.hpp"
#include "converter/build/scan.hpp"
#include "shared/format/node_entry.hpp"

#include <span>

namespace stipple {

struct CompareOptions {
    int threads = 1;
    std::uint64_t memoryBytes = 0; // for points; half of it for those that wait
    std::string temp;              // folder for those that don't fit
    const std::atomic<bool>* stop = nullptr;
    std::atomic<std::uint64_t>* temporaryBytes = nullptr; // kept up to date
};

// What is compared with the inputs.
struct FileNodes {
    const CloudMetadata& metadata;
    std::span<const NodeEntry> entries;
    // A node's points, until the next call of that worker (in [0, threads)); null if it can't be read, which
    // is known elsewhere. Each node is asked for once.
    std::function<Result<const PointBatch*>(const NodeEntry&, int worker)> read;
};

struct InputComparison {
    Comparison comparison;
    PointSums sums; // of the inputs, without their hash
    // For each unmatched attribute that is imposed: whether any value in the inputs is not 0.
    std::vector<std::uint8_t> unmatchedHoldValues;
};

// `scan` must be mapped onto the file's grid and schema; `unmatched` is what mapOnto() answered.
// Errors: those of the inputs; writeFailed where points can't be put aside; limitExceeded for memory.
Result<InputComparison> compareWithInputs(const Scan& scan, std::span<const UnmatchedAttribute> unmatched,
                                          const FileNodes& file, const CompareOptions& options,
                                          const ConvertProgress& progress);

} // namespace stipple
