// Points with every kind of attribute, for tests that damage files.
#pragma once

#include "shared/points/point_batch.hpp"

#include <cstdint>

namespace stipple::test {

// `count` points of `schema` inside the cube [0, 2^bits) of grid steps, near a wavy surface. Values are
// random but fit the fields of any LAS point format.
PointBatch samplePoints(const Schema& schema, std::size_t count, int bits, std::uint64_t seed);

} // namespace stipple::test
