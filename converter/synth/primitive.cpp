#include "converter/synth/primitive.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

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
