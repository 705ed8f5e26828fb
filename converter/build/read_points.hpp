// All points of the inputs into memory, on the cloud's grid and in its schema; what is summed on the way.
#pragma once

#include "converter/build/convert.hpp"
#include "converter/build/point_store.hpp"
#include "converter/build/scan.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/geometry/box.hpp"

#include <array>

namespace stipple {

// What decides which colour travels with the positions.
struct ColourExtremes {
    std::array<std::uint16_t, 3> rgbMax{}; // 0 where the attribute is absent or no uint16
    std::uint16_t intensityMin = 0xFFFF, intensityMax = 0;

    void extend(const ColourExtremes& other);
};

struct LoadedPoints {
    PointStore store;
    BoxI bounds;
    PointHash hash;
    ColourExtremes colour;
    double maxGridError = 0; // world units; > 0 only where inputs do not fit one grid exactly
    std::vector<std::string> warnings;
};

// Reads each input once. Errors: those of the readers; limitExceeded if memory does not suffice.
Result<LoadedPoints> readPoints(const Scan& scan, int threads, const std::atomic<bool>* stop,
                                const ConvertProgress& progress);

} // namespace stipple
