// Points as JSON: one object,
//
//   {HEAD "columns": ["X", "Y", "Z", "Intensity", "name[0]", …],
//    "points": [[637012.24, 849028.31, 431.66, 143, 7], …]}
//
// Values are those of CSV (csv_sink.hpp): coordinates and scaled attributes as exact decimals. Null stands
// for "no value" (noData), and for what JSON has no number for: NaN and infinity. Text that is no UTF-8 has
// replacement characters.
#pragma once

#include "shared/io/byte_sink.hpp"
#include "shared/sinks/point_sink.hpp"

#include <memory>
#include <string>

namespace stipple {

// `head`: members that come first, as JSON, each followed by a comma; may be empty.
Result<std::unique_ptr<PointSink>> jsonSink(std::unique_ptr<ByteSink> to, const SinkInput& input,
                                            const std::string& head = "");

} // namespace stipple
