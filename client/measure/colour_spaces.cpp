#include "client/measure/colour_spaces.hpp"

#include <array>

namespace stipple::measure {
namespace {

// Rows of sRGB's primaries in XYZ, as ratios of the integers of the standard's chromaticities.
using Matrix = std::array<Vec3d, 3>;
constexpr Matrix xyzOfLinear{Vec3d{10135552.0 / 24577794, 8788810.0 / 24577794, 4435075.0 / 24577794},
                             Vec3d{2613072.0 / 12288897, 8788810.0 / 12288897, 887015.0 / 12288897},
                             Vec3d{1425312.0 / 73733382, 8788810.0 / 73733382, 70074185.0 / 73733382}};

Vec3d times(const Matrix& m, Vec3d v) {
    return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

// Each row divided by what white has of it.
Matrix relativeToWhite() {
    Matrix m = xyzOfLinear;
    for (Vec3d& row : m)
        row = row * (1 / (row.x + row.y + row.z));
    return m;
}

// By cofactors.
Matrix inverseOf(const Matrix& m) {
    Vec3d a = cross(m[1], m[2]), b = cross(m[2], m[0]), c = cross(m[0], m[1]);
    double scale = 1 / dot(m[0], a);
    return {Vec3d{a.x, b.x, c.x} * scale, Vec3d{a.y, b.y, c.y} * scale, Vec3d{a.z, b.z, c.z} * scale};
}

} // namespace

Vec3d whiteRelativeOfLinear(Vec3d linear) {
    static const Matrix matrix = relativeToWhite();
    return times(matrix, linear);
}

Vec3d linearOfWhiteRelative(Vec3d xyz) {
    static const Matrix matrix = inverseOf(relativeToWhite());
    return times(matrix, xyz);
}

Vec3d labOf(Vec3d xyz) {
    constexpr double delta = 6.0 / 29;
    auto root = [](double value) {
        return value > delta * delta * delta ? std::cbrt(value) : value / (3 * delta * delta) + 4.0 / 29;
    };
    double x = root(xyz.x), y = root(xyz.y), z = root(xyz.z);
    return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

} // namespace stipple::measure
