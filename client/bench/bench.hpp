// The whole of `stipple bench`: clouds × camera paths × modes × budgets.
#pragma once

#include "client/bench/results.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace stipple::bench {

struct BenchOptions {
    std::vector<std::string> clouds;    // .stipple files
    std::vector<std::string> pathNames; // built-in ones, made for each cloud
    std::vector<CameraPath> paths;      // further ones, in world coordinates
    std::vector<Mode> modes;
    std::vector<std::uint64_t> budgets{2'000'000}; // points, of the modes that sweep
    std::uint64_t usualBudget = 2'000'000;         // of the others
    int width = 1280, height = 720;
    int frames = 6;          // of built-in paths
    int repeats = 3;         // warm passes along each path
    int samples = 1;         // samples × samples a pixel in the references
    int threads = 0;         // 0: one per core
    std::string cacheFolder; // of reference pictures; empty: they are drawn anew each time
    bool pictures = true;    // keep pictures: for each cloud, mode and budget one frame
    // What is being done, and how much of it.
    std::function<void(const std::string& phase, std::uint64_t done, std::uint64_t total)> progress;
};

// Errors: invalidArgument for options that have no meaning, before anything is read; those of reading,
// loading, drawing; unsupported for a mode whose renderer this machine lacks.
Result<BenchResult> runBench(const BenchOptions& options);

} // namespace stipple::bench
