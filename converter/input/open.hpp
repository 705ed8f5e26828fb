// Any file to a PointInput. Files are told by their first bytes, never by their names; text of points by a
// first line of data with three numbers, below comments and at most one line of names.
#pragma once

#include "converter/input/point_input.hpp"

#include <atomic>

namespace stipple {

struct InputOptions {
    // Names of the columns of text files: "x,y,z,intensity,…"; "-" skips one. Empty: the header, or a guess.
    std::string columns = {};
    // Grid step of inputs whose coordinates are floats or decimals, world units. 0: chosen by what they hold
    // (input/float_grid.hpp).
    double scale = 0;
    // What reads a file once when it is opened, because its header does not state what it holds, does so with
    // so many threads. They decide nothing but the time.
    int threads = 1;
    // Once true, whatever reads the file ends with `cancelled`, also opening it. Must outlive the input.
    const std::atomic<bool>* stop = nullptr;
};

// Errors name the file: missing, a folder, empty, of a kind that is not read, damaged.
Result<std::unique_ptr<PointInput>> openInput(const std::string& path, const InputOptions& options = {});

// What openInput would take a file for, by its start alone; it may still be damaged.
enum class InputKind : std::uint8_t {
    scan,
    cloud,   // a .stipple file
    notRead, // of another kind, empty, or can't be opened
};
InputKind inputKindOf(const std::string& path);

} // namespace stipple
