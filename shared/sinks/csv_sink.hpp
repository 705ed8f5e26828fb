// Points as comma-separated values (RFC 4180, but lines end in LF), UTF-8:
//
//   X,Y,Z,Intensity,"Height, above ground",…     names as they are; "name[0]", "name[1]" for several
//   components 637012.24,849028.31,431.66,143,12.07,…
//
// Coordinates are exact decimals (decimal.hpp), so the grid integers can be told from them. Attributes with a
// scale or offset are written as the values they mean, offset + scale × stored, as exact decimals too; others
// as they are stored. Floating point is the shortest text that reads back equal. A value that means "no
// value" (noData) is an empty field. A CSV file has no place for the CRS.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/sinks/point_sink.hpp"

#include <memory>

namespace stipple {

Result<std::unique_ptr<PointSink>> csvSink(std::unique_ptr<ByteSink> to, const SinkInput& input);

} // namespace stipple
