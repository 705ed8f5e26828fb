// Ranges of what an attribute's values mean, as ranges of the values that are stored.
#pragma once

#include "shared/points/attribute.hpp"
#include "shared/select/point_filter.hpp"

#include <vector>

namespace stipple {

// The stored values whose meaning, offset + scale × stored, lies in one of `ranges`; a value that means "no
// value" is in none. Limits are decimals that people write, scales are too, and neither is exact in double: a
// limit that is nearer to the meaning of a whole stored value than rounding tells (2^-50 of its size, or a
// billionth of a step) is that value. Attributes without scale and offset keep their ranges as they are.
std::vector<ValueRange> storedRanges(const Attribute& attribute, const std::vector<ValueRange>& ranges);

} // namespace stipple
