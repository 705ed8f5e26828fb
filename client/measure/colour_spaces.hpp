// The colour spaces of FLIP (flip.hpp). Standard illuminant D65 throughout; XYZ has Y = 1 for white.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <cmath>

namespace stipple::measure {

// IEC 61966-2-1; levels and result 0..1.
inline double linearOfSrgb(double level) {
    return level > 0.04045 ? std::pow((level + 0.055) / 1.055, 2.4) : level / 12.92;
}

// XYZ relative to the white point, so that white is (1, 1, 1).
Vec3d whiteRelativeOfLinear(Vec3d linear);
Vec3d linearOfWhiteRelative(Vec3d xyz);

// YyCxCz (Kolpatzik and Bouman 1992): CIELAB's form, linear.
inline Vec3d ycxczOf(Vec3d xyz) {
    return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}
inline Vec3d whiteRelativeOfYcxcz(Vec3d c) {
    double y = (c.x + 16) / 116;
    return {y + c.y / 500, y, y - c.z / 200};
}

// CIELAB (CIE 15:2004) from XYZ relative to white.
Vec3d labOf(Vec3d xyz);
// Hunt's effect: colours look less colourful in the dark.
inline Vec3d huntAdjusted(Vec3d lab) {
    return {lab.x, 0.01 * lab.x * lab.y, 0.01 * lab.x * lab.z};
}
// Abasi, Tehran, Fairchild 2020: city-block between lightness and chroma.
inline double hyab(Vec3d a, Vec3d b) {
    return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z);
}

} // namespace stipple::measure
