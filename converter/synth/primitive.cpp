#include "converter/synth/primitive.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

// Möller and Trumbore 1997. A hair of slack lets neighbours meet without a crack; at the largest triangle
// (some 50 m) it is 5e-8 m.
double intersectTriangle(const Primitive& p, const Ray& ray, double from) {
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

double intersectDisc(const Primitive& p, const Ray& ray, double from) {
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
double intersectSphere(const Primitive& p, const Ray& ray, double from) {
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

double intersectFrustum(const Primitive& p, const Ray& ray, double from) {
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

// Ericson 2005, "Real-Time Collision Detection", §5.1.5.
double distanceToTriangle(const Primitive& t, Vec3d p) {
    Vec3d a = toDouble(t.a), b = toDouble(t.b), c = toDouble(t.c);
    Vec3d ab = b - a, ac = c - a, ap = p - a;
    double d1 = dot(ab, ap), d2 = dot(ac, ap);
    if (d1 <= 0 && d2 <= 0)
        return length(ap);
    Vec3d bp = p - b;
    double d3 = dot(ab, bp), d4 = dot(ac, bp);
    if (d3 >= 0 && d4 <= d3)
        return length(bp);
    double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0)
        return length(ap - ab * (d1 / (d1 - d3)));
    Vec3d cp = p - c;
    double d5 = dot(ab, cp), d6 = dot(ac, cp);
    if (d6 >= 0 && d5 <= d6)
        return length(cp);
    double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0)
        return length(ap - ac * (d2 / (d2 - d6)));
    double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0)
        return length(bp - (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6))));
    return std::abs(dot(ap, normalized(cross(ab, ac))));
}

// In the half-plane (along the axis, away from it) the lateral surface is a segment.
double distanceToFrustum(const Primitive& f, Vec3d p) {
    Vec3d a = toDouble(f.a), axis = toDouble(f.b) - a;
    double size = length(axis);
    Vec3d n = axis * (1 / size), w = p - a;
    double along = dot(w, n), away = length(w - n * along);
    double dr = static_cast<double>(f.radiusEnd) - f.radius;
    double t = (along * size + (away - f.radius) * dr) / (size * size + dr * dr);
    t = std::clamp(t, 0.0, 1.0);
    return std::hypot(along - t * size, away - (f.radius + t * dr));
}

double distanceToDisc(const Primitive& d, Vec3d p) {
    Vec3d w = p - toDouble(d.a), n = toDouble(d.b);
    double height = dot(w, n), away = length(w - n * height);
    return std::hypot(height, std::max(0.0, away - d.radius));
}

} // namespace

double intersect(const Primitive& primitive, const Ray& ray, double from) {
    switch (primitive.shape) {
    case Primitive::Shape::triangle:
        return intersectTriangle(primitive, ray, from);
    case Primitive::Shape::disc:
        return intersectDisc(primitive, ray, from);
    case Primitive::Shape::frustum:
        return intersectFrustum(primitive, ray, from);
    case Primitive::Shape::sphere:
        return intersectSphere(primitive, ray, from);
    }
    return noHit;
}

Vec3d normalAt(const Primitive& p, Vec3d point) {
    Vec3d a = toDouble(p.a);
    switch (p.shape) {
    case Primitive::Shape::triangle:
        return normalized(cross(toDouble(p.b) - a, toDouble(p.c) - a));
    case Primitive::Shape::disc:
        return toDouble(p.b);
    case Primitive::Shape::sphere:
        return normalized(point - a);
    case Primitive::Shape::frustum: {
        Vec3d axis = toDouble(p.b) - a;
        double size = length(axis);
        Vec3d n = axis * (1 / size), w = point - a;
        Vec3d out = normalized(w - n * dot(w, n));
        return normalized(out - n * ((static_cast<double>(p.radiusEnd) - p.radius) / size));
    }
    }
    return {0, 0, 1};
}

double distanceTo(const Primitive& p, Vec3d point) {
    switch (p.shape) {
    case Primitive::Shape::triangle:
        return distanceToTriangle(p, point);
    case Primitive::Shape::disc:
        return distanceToDisc(p, point);
    case Primitive::Shape::sphere:
        return std::abs(length(point - toDouble(p.a)) - p.radius);
    case Primitive::Shape::frustum:
        return distanceToFrustum(p, point);
    }
    return noHit;
}

Box<float> boundsOf(const Primitive& p) {
    Box<float> box;
    auto around = [&](Vec3f centre, float r) {
        box.extend(Vec3f{centre.x - r, centre.y - r, centre.z - r});
        box.extend(Vec3f{centre.x + r, centre.y + r, centre.z + r});
    };
    switch (p.shape) {
    case Primitive::Shape::triangle:
        box.extend(p.a);
        box.extend(p.b);
        box.extend(p.c);
        break;
    case Primitive::Shape::disc:
        // A disc reaches radius × sqrt(1 - n²) along an axis.
        for (int axis = 0; axis < 3; ++axis) {
            float reach = p.radius * std::sqrt(std::max(0.0f, 1 - p.b[axis] * p.b[axis]));
            box.min[axis] = p.a[axis] - reach;
            box.max[axis] = p.a[axis] + reach;
        }
        break;
    case Primitive::Shape::frustum:
        around(p.a, p.radius);
        around(p.b, p.radiusEnd);
        break;
    case Primitive::Shape::sphere:
        around(p.a, p.radius);
        break;
    }
    return box;
}

} // namespace stipple::synth
