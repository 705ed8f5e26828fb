// Whether a place lies in a region, in long double and from the definitions of what regions are
// (shared/select/region_shape.hpp), not by way of triangles or half-spaces. Wrong only where a place is
// within some 1e-18 of a region's size from its edge.
#pragma once

#include "client/reference/view.hpp"
#include "shared/select/region_shape.hpp"

namespace stipple::reference {

bool isInBox(const RegionShape::Box& box, const Vec3l& world);
bool isInShape(const RegionShape& shape, const Vec3l& world);

} // namespace stipple::reference
