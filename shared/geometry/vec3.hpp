// Three numbers of one type. Axis order is x, y, z everywhere.
#pragma once

#include <cmath>
#include <cstdint>

namespace stipple {

template <class T>
struct Vec3 {
    T x{}, y{}, z{};

    T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
    const T& operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
    friend bool operator==(const Vec3&, const Vec3&) = default;

    friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator*(Vec3 a, T s) { return {a.x * s, a.y * s, a.z * s}; }
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Vec3i = Vec3<std::int64_t>;

template <class T>
T dot(Vec3<T> a, Vec3<T> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double length(Vec3d a) {
    return std::sqrt(dot(a, a));
}
inline Vec3d normalized(Vec3d a) {
    double size = length(a);
    return size > 0 ? a * (1 / size) : a;
}

} // namespace stipple
