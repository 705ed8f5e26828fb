// Where rays meet primitives. Inline, because a traversal calls it at every leaf.
#pragma once

#include "converter/synth/primitive.hpp"

#include <cmath>
#include <utility>

namespace stipple::synth {

namespace detail {

// Möller and Trumbore 1997. A hair of slack lets neighbours meet without a crack; at the largest triangle
// (some 50 m) it is 5e-8 m.
inline double intersectTriangle(const Primitive& p, const Ray& ray, double from) {
    Vec3d a = toDouble(p.a), e1 = toDouble(p.b) - a, e2 = toDouble(p.c) - a;
    Vec3d h = cross(ray.direction, e2);
    double det = dot(e1, h);
    if (det == 0)
        return noHit;
    double inv = 1 / det;
    Vec3d s = ray.origin - a;
    double u = dot(s, h) * inv;
    constexpr double slack = 1e-9;
    if (u < -slack || u > 1 + slack)
        return noHit;
    Vec3d q = cross(s, e1);
    double v = dot(ray.direction, q) * inv;
    if (v < -slack || u + v > 1 + slack)
        return noHit;
    double t = dot(e2, q) * inv;
    return t > from ? t : noHit;
}

inline double intersectDisc(const Primitive& p, const Ray& ray, double from) {
    Vec3d n = toDouble(p.b), w = toDouble(p.a) - ray.origin;
    double slope = dot(ray.direction, n);
    if (slope == 0)
        return noHit;
    double t = dot(w, n) / slope;
    Vec3d off = ray.direction * t - w;
    return t > from && dot(off, off) <= static_cast<double>(p.radius) * p.radius ? t : noHit;
}

// Both quadrics are solved from the point of the ray nearest to them: from a kilometre away the terms of the
// textbook formula would cancel to a millimetre.
inline double intersectSphere(const Primitive& p, const Ray& ray, double from) {
    Vec3d w = ray.origin - toDouble(p.a);
    double dd = dot(ray.direction, ray.direction);
    double nearest = -dot(w, ray.direction) / dd;
    Vec3d m = w + ray.direction * nearest;
    double under = static_cast<double>(p.radius) * p.radius - dot(m, m);
    if (under < 0)
        return noHit;
    double half = std::sqrt(under / dd);
    if (nearest - half > from)
        return nearest - half;
    return nearest + half > from ? nearest + half : noHit;
}

inline double intersectFrustum(const Primitive& p, const Ray& ray, double from) {
    Vec3d a = toDouble(p.a), axis = toDouble(p.b) - a;
    double size = length(axis);
    Vec3d n = axis * (1 / size);
    double k = (static_cast<double>(p.radiusEnd) - p.radius) / size;
    double nearest = -dot(ray.origin - a, ray.direction) / dot(ray.direction, ray.direction);
    Vec3d w = ray.origin - a + ray.direction * nearest;
    double ds = dot(ray.direction, n), ws = dot(w, n);
    double r = p.radius + k * ws;
    double A = dot(ray.direction, ray.direction) - ds * ds * (1 + k * k);
    double B = dot(w, ray.direction) - ws * ds - k * ds * r;
    double C = dot(w, w) - ws * ws - r * r;
    double discriminant = B * B - A * C;
    if (discriminant < 0 || A == 0)
        return noHit;
    double root = std::sqrt(discriminant);
    double t1 = (-B - root) / A, t2 = (-B + root) / A;
    if (t1 > t2)
        std::swap(t1, t2);
    for (double t : {t1, t2}) {
        double along = ws + t * ds;
        if (nearest + t > from && along >= 0 && along <= size && p.radius + k * along >= 0)
            return nearest + t;
    }
    return noHit;
}

} // namespace detail

// Distance to the first crossing beyond `from`, or noHit. Surfaces have two sides.
inline double intersect(const Primitive& primitive, const Ray& ray, double from) {
    switch (primitive.shape) {
    case Primitive::Shape::triangle:
        return detail::intersectTriangle(primitive, ray, from);
    case Primitive::Shape::disc:
        return detail::intersectDisc(primitive, ray, from);
    case Primitive::Shape::frustum:
        return detail::intersectFrustum(primitive, ray, from);
    case Primitive::Shape::sphere:
        return detail::intersectSphere(primitive, ray, from);
    }
    return noHit;
}

} // namespace stipple::synth
