// What `stipple bench` found out. Times are seconds; shares are 0..1; levels 0..255.
#pragma once

#include "client/bench/camera_path.hpp"
#include "client/bench/machine.hpp"
#include "client/bench/mode.hpp"
#include "client/bench/statistics.hpp"
#include "client/core/counters.hpp"
#include "client/measure/depth_error.hpp"
#include "client/measure/pixel_error.hpp"
#include "client/render/image.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stipple::bench {

struct FrameResult {
    FrameCounters counters;
    // Cold: the first pass along the path, with an empty cache at its start.
    std::uint64_t bytesFetched = 0, requests = 0;
    double loadSeconds = 0; // from the camera's move until everything that the view wants was there
    // Warm: the passes after it. `select`: one update of the session after the camera moved, which selects
    // anew and makes the plan; `draw`: the plan to a picture, with GLES including reading it back.
    Spread select, draw;
    std::uint64_t bytesReloaded = 0; // what had left the cache by the warm passes: 0, or times are not warm
    // Against the reference.
    measure::PixelError pixels;
    double ssim = 0, flip = 0;
    measure::DepthError depth;
    // Mean pixel error between this frame and the one before it, and the same of their references: what a
    // path changes, and how much of it the reference changes too.
    std::optional<double> change, referenceChange;
};

struct Run {
    std::string cloud, path, mode;
    std::uint64_t budget = 0; // points
    std::string renderer;     // "software", or the GL driver
    std::vector<FrameResult> frames;
};

// One frame to look at, scaled down to samplePictureWidth where it is wider.
inline constexpr int samplePictureWidth = 480;
struct SamplePictures {
    std::string cloud, path, mode;
    std::uint64_t budget = 0;
    std::size_t frame = 0;
    Image picture, reference, difference, flip;
};

struct CloudResult {
    std::string name; // of the file, without folder and ending
    std::uint64_t points = 0;
    std::string pointHash;
    BoxD bounds;
    std::vector<CameraPath> paths;
    // What modes ask for that the cloud has not, or the driver can't do, and what was drawn instead: "MODE:
    // SENTENCE".
    std::vector<std::string> limitations{};
};

struct BenchResult {
    Machine machine;
    int width = 0, height = 0, repeats = 0, samples = 1, threads = 0;
    std::vector<Mode> modes;
    std::vector<CloudResult> clouds;
    std::vector<Run> runs;
    std::vector<SamplePictures> pictures;
};

// All frames of all paths of one cloud, mode and budget together.
struct Summary {
    std::string cloud, mode, renderer;
    std::uint64_t budget = 0;
    std::size_t frames = 0;
    double drawSeconds = 0, selectSeconds = 0;                        // medians over the frames
    double pointsConsidered = 0, pointsSelected = 0, pointsDrawn = 0; // means over the frames
    double nodesDrawn = 0, pixelsCovered = 0;                         // …
    double bytesFetched = 0;                                          // … cold
    double meanError = 0, rms = 0, ssim = 0, flip = 0;                // …
    double wrongDepth = 0, holes = 0, extra = 0;                      // shares, …
    double largest = 0;                                               // levels, of all frames
    double popping = 0; // mean of |change - referenceChange| where there is a frame before, levels
};
// In the order of the runs.
std::vector<Summary> summarise(const std::vector<Run>& runs);

// A mode against the one that it names (Mode::against), of the same cloud and, where both sweep, the same
// budget: quotients of times, counts and bytes (NaN where the other has none), differences of errors.
struct Comparison {
    std::string cloud, mode, against, group;
    std::uint64_t budget = 0;
    double drawSeconds = 1, selectSeconds = 1, nodesDrawn = 1, pointsDrawn = 1, bytesFetched = 1;
    double meanError = 0, ssim = 0, flip = 0, holes = 0;
};
// In the order of the summaries; pairs of which one was not run are left out.
std::vector<Comparison> compare(const std::vector<Summary>& summaries, const std::vector<Mode>& modes);

} // namespace stipple::bench
