// Station and offset of the points of a profile as two attributes more, behind those that a cloud stores.
// They are computed while points are walked (CloudFilter::placesAlong); sinks see no difference.
#pragma once

#include "shared/format/cloud_metadata.hpp"

namespace stipple {

// Appends "Station" (world units along the line) and "Offset" (world units beside it, positive to the left),
// both float64, to the schema. An attribute that has such a name already keeps it, and the new one gets a
// number.
void addCorridorAttributes(CloudMetadata& metadata);

} // namespace stipple
