// What the header of a LAS file says of points that are yet to be written: counts, bounds, ranges. For sinks
// that can't be written twice.
#pragma once

#include "converter/export/walk_points.hpp"
#include "shared/sinks/las_sink.hpp"

namespace stipple {

// Walks the points without writing them, and reads no more of the nodes than the header needs (positions,
// return numbers, extra bytes). Of a cloud that is wanted whole and has no extra bytes, nothing: its metadata
// know. `plan` was made for `input`. Errors: those of walkPoints().
Result<las::PointSummary> summarizeForLas(CloudReader& reader, const std::string& name,
                                          const CloudFilter& filter, const SinkInput& input,
                                          const LasPlan& plan, const WalkOptions& options);

} // namespace stipple
