// Scans in, one `.stipple` file out. The phases, each a function with plain structs between them:
//
//   scan    headers → one grid, one schema, one CRS (scan.hpp)
//   tile    points → cells of the octree, in memory or on disk (tile.hpp)
//   sample  subtree by subtree, bottom-up: each point to exactly one node, each node encoded (build.hpp)
//   pack    nodes in their order → the file (cloud_writer.hpp)
//
// The bytes depend on the points and the options alone: not on the order of the inputs, the number of
// threads or the memory allowed. What is done is kept in a folder beside the output (work_folder.hpp): killed
// at any moment, the same call goes on and ends with the same bytes.
#pragma once

#include "converter/input/open.hpp"
#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/cloud_writer.hpp"

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

// How the work is cut. No option of a user: tests of small clouds set them lower.
struct WorkSizes {
    std::uint64_t pointsPerRound = std::uint64_t{1} << 23; // read between two checkpoints
    // Memory of one subtree at work, which decides how large subtrees are: the same for any memoryBytes, as
    // it decides the bytes of the file.
    std::uint64_t subtreeBytes = std::uint64_t{1} << 27;
};

struct ConvertOptions {
    std::string name = {}; // of the cloud; empty: the output's file name without its extension
    std::string crs = {};  // of the cloud, "EPSG:n" (ScanOptions::crs); empty: what the inputs state
    InputOptions input = {};
    Sampling sampling = Sampling::poisson; // how points of coarse nodes are chosen
    // What coarse nodes show, if the cloud has a colour. Nothing: mean RGB, exact intensities.
    std::optional<InnerColour> innerColour = {};
    int threads = 0; // 0: one for each core
    // For points, at least leastMemoryBytes (memory_share.hpp); the process has up to 200 MB besides. 0: a
    // quarter of the machine's.
    std::uint64_t memoryBytes = 0;
    std::string temp = {}; // folder for what does not fit memory, and checkpoints; empty: beside the output
    // A cloud that the inputs are added to; may be the output, which is replaced when all is done.
    std::string append = {};
    // Take points in that a cloud among the inputs holds already (known_sources.hpp).
    bool allowDuplicates = false;
    bool strict = false; // refuse inputs with points that have to be dropped, or that are not there
    // Replace an existing output that is no Stipple file. An input is never replaced.
    bool force = false;
    WorkSizes sizes = {};
    const std::atomic<bool>* stop = nullptr;              // once true, the conversion ends with `cancelled`
    std::atomic<std::uint64_t>* temporaryBytes = nullptr; // kept up to date, for a display
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
    std::uint64_t temporaryBytes = 0; // of points that went to disk for the time being
    bool resumed = false;             // an earlier run's work was taken up
    ReadReport dropped;               // points that were left out, by reason
    double largestRounding = 0;       // distance from a stated coordinate to the cloud's grid, world units
    PhaseSeconds seconds;
    std::vector<std::string> warnings; // one sentence each
};

// Errors: what the inputs are at fault for as they are; what the output is at fault for
// as writeFailed. Nothing is left behind on failure; an older file of that name stays as it was.
Result<ConvertResult> convertFiles(const std::vector<std::string>& inputs, const std::string& output,
                                   const ConvertOptions& options, const ConvertProgress& progress);

// The output `convert` takes when none is given: in the current folder, named after the first input.
std::string defaultOutput(const std::vector<std::string>& inputs);

} // namespace stipple
