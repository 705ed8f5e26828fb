// The exact surfaces a scene is made of. Their numbers are floats and *define* the surface; all arithmetic
// on them is in double, so a hit lies on its surface to about 1e-10 m at a kilometre.
#pragma once

#include "converter/synth/material.hpp"
#include "shared/geometry/box.hpp"
#include "shared/geometry/vec3.hpp"

#include <cstdint>
#include <limits>

namespace stipple::synth {

struct Ray {
    Vec3d origin;
    Vec3d direction; // any length > 0; distances along the ray are in units of it
};

inline constexpr double noHit = std::numeric_limits<double>::infinity();

struct Primitive {
    enum class Shape : std::uint8_t {
        triangle, // corners a, b, c
        disc,     // centre a, unit normal b, radius
        frustum,  // lateral surface from a (radius) to b (radiusEnd): cylinders, cones; no caps
        sphere,   // centre a, radius
    };
    Shape shape = Shape::triangle;
    Material material = Material::concrete;
    std::uint32_t tag = 0; // ground: which cell (Ground::uvAt)
    Vec3f a, b, c;
    float radius = 0, radiusEnd = 0;
};

// Unit normal at a point of the surface, on no particular side.
Vec3d normalAt(const Primitive& primitive, Vec3d point);

// Distance of any point to the surface.
double distanceTo(const Primitive& primitive, Vec3d point);

Box<float> boundsOf(const Primitive& primitive);

inline Vec3d toDouble(Vec3f v) {
    return {v.x, v.y, v.z};
}
inline Vec3f toFloat(Vec3d v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

} // namespace stipple::synth
