// Which attributes travel with positions, in the order of NodePicture::colour.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/format/cloud_writer.hpp"

namespace stipple {

// Indices into metadata.schema.attributes; -1 for one that the schema lacks.
std::vector<int> pictureAttributes(const CloudMetadata& metadata);
// Errors: invalidArgument if one is missing or is not a single u16.
Status checkPictureAttributes(const CloudMetadata& metadata);

} // namespace stipple
