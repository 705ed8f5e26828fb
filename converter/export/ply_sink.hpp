// Points as a PLY file, binary little-endian, one element "vertex":
//
//   double x, y, z       grid.toWorld() of the grid integers
//   a property for each attribute and component, of its own type: uchar, char, ushort, short, uint, int,
//   float, double
//
// Names of LAS attributes are in lower case with underscores (red, green, blue, intensity, classification,
// gps_time), others as they are but for spaces. Colours are uchar where the cloud's are 8-bit, else ushort.
// Attributes with a scale or offset are written as the values they mean, in double; noData of those is NaN.
// PLY has no 64-bit integers: they are double where all are below 2^53, else two properties, NAME_low and
// NAME_high (× 2^32). Comments tell the CRS (as WKT on one line) and what was done to which attribute.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/sinks/point_sink.hpp"

#include <memory>
#include <optional>

namespace stipple {

// `count`: how many points will come; needed where the sink of bytes can't be overwritten (invalidArgument),
// because it stands in the header. A count that does not come true fails in finish().
Result<std::unique_ptr<PointSink>> plySink(std::unique_ptr<ByteSink> to, const SinkInput& input,
                                           std::optional<std::uint64_t> count);

} // namespace stipple
