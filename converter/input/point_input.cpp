#include "converter/input/point_input.hpp"

#include <algorithm>

namespace stipple {

void ReadReport::add(const ReadReport& other) {
    notFinite += other.notFinite;
    outOfRange += other.outOfRange;
    invalid += other.invalid;
    untransformable += other.untransformable;
    maxRounding = std::max(maxRounding, other.maxRounding);
}

} // namespace stipple
