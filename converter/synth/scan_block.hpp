// Points of a run of pulses as a batch of columns, and the run's repair when it is cut.
#pragma once

#include "converter/synth/scanner.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/points/point_batch.hpp"

namespace stipple::synth {

// Where the attributes of a scan are in its schema.
struct ScanColumns {
    explicit ScanColumns(const Schema& schema);
    int intensity, returnNumber, numberOfReturns, scanDirection, edge, classification, scanAngle, source,
        gpsTime;
    int red, green, blue;
    std::array<int, 3> normal; // NormalX, NormalY, NormalZ; -1: not wanted
};

// Pulses [first, first + count) of the source.
PointBatch scanPulses(const Scanner& scanner, const Source& source, std::uint64_t seed, std::uint64_t first,
                      std::uint64_t count, const Schema& schema, const ScanColumns& columns, const Grid& grid,
                      Vec3d origin);

// Keeps the first `size` points. If that cuts a pulse apart, its number of returns becomes what is left of
// it.
void cutBatch(PointBatch& batch, std::size_t size, const Schema& schema, const ScanColumns& columns);

} // namespace stipple::synth
