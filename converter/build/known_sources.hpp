// Points that would come into a cloud twice: inputs that another input, itself a cloud, was made of.
#pragma once

#include "converter/build/point_sums.hpp"
#include "converter/build/scan.hpp"

#include <atomic>
#include <string>
#include <vector>

namespace stipple {

struct KnownSourcesOptions {
    std::string append = {}; // the path of the input that the others are added to; empty: there is none
    int threads = 1;
    const std::atomic<bool>* stop = nullptr;
};

// Refuses an input whose points are those of a cloud among the inputs, or of a file that the cloud was made
// of (invalidArgument, naming both). Points are known by their hash, under any name and in any container
// that keeps grid and attributes (LAZ for LAS). Only an input of just as many points is read for it.
// Of files that a cloud names without a hash: by name, format, points and size.
Status refuseKnownSources(const Scan& scan, const KnownSourcesOptions& options);

// Inputs that hold the same points as one before them, a sentence each. `sums`: of the scan's points.
std::vector<std::string> equalInputs(const Scan& scan, const PointSums& sums);

} // namespace stipple
