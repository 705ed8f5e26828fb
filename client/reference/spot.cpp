#include "client/reference/spot.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::reference {
namespace {

double radiusOf(const Mark& mark) {
    return mark.diameter / 2;
}

// The pixel around the mark's place always shows what lies in it.
double holdsMiddle(double dx, double dy) {
    return 0.5 - std::max(std::abs(dx), std::abs(dy));
}

// --- discs ---------------------------------------------------------------------------------------------

struct Meeting {
    bool inside = false;
    double away = std::numeric_limits<double>::infinity(); // world units
    double distance = 0;
    double facing = 1; // of the normal and the place's ray, whose part along the view direction is 1
};

Vec3d facingOf(const Mark& mark) {
    return mark.normal == Vec3d{} ? Vec3d{0, 0, 1} : mark.normal;
}

// Where the ray of the place meets the disc's plane, from the definition.
Meeting meet(const Mark& mark, double dx, double dy) {
    Meeting meeting;
    Vec3d normal = facingOf(mark), middle = Vec3d{mark.rayX, mark.rayY, 1} * mark.distance, hit;
    if (mark.slopePerPixel > 0) {
        Vec3d ray{mark.rayX + dx * mark.slopePerPixel, mark.rayY - dy * mark.slopePerPixel, 1};
        meeting.facing = std::abs(dot(normal, ray));
        hit = ray * (dot(normal, middle) / dot(normal, ray));
    } else {
        hit = {dx * mark.unitsPerPixel, -dy * mark.unitsPerPixel, 0};
        meeting.facing = std::abs(normal.z);
        hit.z = (dot(normal, middle) - normal.x * hit.x - normal.y * hit.y) / normal.z;
    }
    bool isInFront = mark.slopePerPixel == 0 || hit.z > 0;
    if (!isInFront || !std::isfinite(hit.z) || mark.diameter <= 1) // single pixels are flat
        return meeting;
    meeting.away = length(hit - middle);
    meeting.distance = hit.z;
    meeting.inside = meeting.away <= radiusOf(mark) * mark.unitsPerPixel &&
                     std::max(std::abs(dx), std::abs(dy)) <= mostDiscReach;
    return meeting;
}

// A disc seen along its plane to within the slack is a line, which is easily missed.
bool isNearLine(const Mark& mark, double dx, double dy, const Slack& slack) {
    Vec3d normal = facingOf(mark), ray{mark.rayX, mark.rayY, 1};
    double lean = std::hypot(normal.x, normal.y);
    bool isThin = radiusOf(mark) * std::abs(dot(normal, ray)) / length(ray) < 4 * slack.pixels;
    return isThin && std::abs(normal.x * dx - normal.y * dy) < 8 * slack.pixels * lean;
}

// What the slack does to a place: whether it might come or go, and how its distance changes.
void doubtDisc(const Mark& mark, double dx, double dy, const Meeting& meeting, const Slack& slack,
               Spot& spot) {
    double radius = radiusOf(mark) * mark.unitsPerPixel, change = 0;
    constexpr double sizeStep = 1.0 / 64; // renderers round sizes to it
    bool unsure =
        isNearLine(mark, dx, dy, slack) || std::abs(mark.diameter - 1 - sizeStep / 2) < sizeStep / 2;
    // Where a disc is no line, the slack changes that by a quarter of the radius at most.
    if (!unsure && !meeting.inside && meeting.away > 1.5 * radius)
        return;
    for (int i = 0; i < 8; ++i) {
        double angle = i * std::acos(-1.0) / 4;
        double right = slack.pixels * std::cos(angle), down = slack.pixels * std::sin(angle);
        Mark moved = mark; // and its plane with it
        moved.rayX += right * mark.slopePerPixel;
        moved.rayY -= down * mark.slopePerPixel;
        Meeting other = meet(moved, dx - right, dy - down);
        unsure = unsure || other.inside != meeting.inside;
        if (!other.inside || !meeting.inside)
            continue;
        change = std::max(change, std::abs(other.distance - meeting.distance));
        spot.wander = std::max(spot.wander, std::abs(other.away - meeting.away) / mark.unitsPerPixel);
    }
    double turned = slack.radians * std::min(meeting.away, radius) / meeting.facing;
    spot.spread = unsure ? 2 * radius : meeting.inside ? std::min(change + turned, 2 * radius) : 0;
    if (unsure)
        spot.inside = std::max(meeting.inside ? slack.pixels / 2 : -slack.pixels / 2, holdsMiddle(dx, dy));
}

Spot spotOnDisc(const Mark& mark, double dx, double dy, const Slack* slack) {
    constexpr double farOff = 1e3;
    Meeting meeting = meet(mark, dx, dy);
    Spot spot;
    spot.inside = std::max(meeting.inside ? farOff : -farOff, holdsMiddle(dx, dy));
    // A place that only holds the point counts for as little as any.
    spot.away = meeting.inside ? meeting.away / mark.unitsPerPixel : radiusOf(mark);
    spot.distance = meeting.inside ? std::clamp(meeting.distance, mark.near, mark.far) : mark.distance;
    if (slack)
        doubtDisc(mark, dx, dy, meeting, *slack, spot);
    return spot;
}

// --- the others ----------------------------------------------------------------------------------------

Spot spotOnParaboloid(const Mark& mark, Spot spot, const Slack* slack) {
    if (mark.diameter <= 1) // single pixels are flat
        return spot;
    double share = spot.away / radiusOf(mark);
    spot.distance += radiusOf(mark) * mark.unitsPerPixel * share * share;
    spot.spread =
        slack ? 2 * mark.unitsPerPixel * slack->pixels : 0; // twice a pixel's width a pixel, at most
    return spot;
}

} // namespace

Spot spotOf(const Mark& mark, double dx, double dy, PointShape shape, const Slack* slack) {
    if (shape == PointShape::disc)
        return spotOnDisc(mark, dx, dy, slack);
    Spot spot;
    spot.away = std::hypot(dx, dy);
    spot.wander = slack ? slack->pixels : 0;
    spot.distance = mark.distance;
    double from = shape == PointShape::square ? std::max(std::abs(dx), std::abs(dy)) : spot.away;
    spot.inside = std::max(radiusOf(mark) - from, holdsMiddle(dx, dy));
    return shape == PointShape::paraboloid ? spotOnParaboloid(mark, spot, slack) : spot;
}

double reachOf(const Mark& mark, PointShape shape) {
    double radius = std::max(radiusOf(mark), 0.5);
    if (shape != PointShape::disc)
        return radius;
    // What leans towards the eye is seen larger, and so is what lies off the middle.
    double nearest = 1 - radiusOf(mark) * mark.slopePerPixel;
    double seen = radius * std::hypot(1, mark.rayX, mark.rayY) / std::max(nearest, 1e-9);
    return std::min(seen, mostDiscReach);
}

} // namespace stipple::reference
