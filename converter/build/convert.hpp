// Scans in, one `.stipple` file out. The phases, each a function with plain structs between them:
//
//   scan    headers → one grid, one schema, one CRS (scan.hpp)
//   tile    points → memory, in Morton order; an octree over that order (tile.hpp)
//   sample  bottom-up, each point to exactly one node (sample.hpp)
//   pack    nodes → encoded blocks, statistics, the file (pack.hpp)
//
// The bytes depend on the points and the options alone: not on the order of the inputs, not on the number
// of threads. All points are held in memory (about twice their size in a LAS file).
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/cloud_writer.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stipple {

struct ConvertOptions {
    std::string name = {}; // of the cloud; empty: the output's file name without its extension
    std::string crs = {};  // of the cloud, "EPSG:n" (ScanOptions::crs); empty: what the inputs state
    int threads = 0;       // 0: one for each core
    // Replace an existing output that is no Stipple file. An input is never replaced.
    bool force = false;
    const std::atomic<bool>* stop = nullptr; // once true, the conversion ends with `cancelled`
};

// Work done in a phase ("scan", "tile", "sample", "pack"), in points. Called from any thread, one at a time.
using ConvertProgress =
    std::function<void(const std::string& phase, std::uint64_t done, std::uint64_t total)>;

struct PhaseSeconds {
    double scan = 0, tile = 0, sample = 0, pack = 0;
    double total() const { return scan + tile + sample + pack; }
};

struct ConvertResult {
    std::string output;
    CloudMetadata metadata;
    WrittenCloud written;
    PhaseSeconds seconds;
    std::vector<std::string> warnings; // one sentence each
};

// Converts LAS files. Errors: what the inputs are at fault for as they are; what the output is at fault for
// as writeFailed. Nothing is left behind on failure; an older file of that name stays as it was.
Result<ConvertResult> convertFiles(const std::vector<std::string>& inputs, const std::string& output,
                                   const ConvertOptions& options, const ConvertProgress& progress);

// The output `convert` takes when none is given: in the current folder, named after the first input.
std::string defaultOutput(const std::vector<std::string>& inputs);

} // namespace stipple
