// Which layers of a layered chunk hold the attributes that are asked for.
#pragma once

#include "shared/las/laz/chunk_codec.hpp"
#include "shared/las/record_layout.hpp"

#include <string>

namespace stipple::las::laz {

// Of the records of `layout` (point formats 6-10). Z is always among them; unknown names are passed over.
Layers layersOf(const RecordLayout& layout, std::span<const std::string> attributes);

} // namespace stipple::las::laz
