// Which points of a cloud are wanted, as a user states it. All conditions must hold.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/corridor.hpp"
#include "shared/geometry/half_space.hpp"
#include "shared/geometry/polygon.hpp"
#include "shared/geometry/screen_prism.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace stipple {

struct ValueRange {
    double min = 0, max = 0; // closed
    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

// The value of an attribute lies in one of the ranges: the stored one, or the one it means
// (value_ranges.hpp). Compared as double: exact for all but 64-bit integers beyond 2^53. NaN lies in none.
struct AttributeCondition {
    std::string attribute;
    std::vector<ValueRange> ranges;
    bool ofMeaning = false; // offset + scale × stored; a value that means "no value" lies in none
};

struct PointFilter {
    // Closed, in world units; sides may be infinite. A point is where grid.toWorld() puts it.
    std::optional<BoxD> box;
    std::optional<BoxI> gridBox; // closed, in grid integers
    // In x and y, world units; edges belong to it (shared/geometry/polygon.hpp).
    std::shared_ptr<const PolygonRegion> region;
    // A rotated box, world units (shared/geometry/oriented_box.hpp).
    std::shared_ptr<const ConvexRegion> convex;
    // What shows inside a polygon on the screen, world units.
    std::shared_ptr<const ScreenPrism> prism;
    // What lies along a line, world units; its points have a station and an offset (corridor_attributes.hpp).
    std::shared_ptr<const Corridor> corridor;
    std::vector<AttributeCondition> conditions;
    // World units; 0: all points. A level of detail: the points of the levels whose spacing (that of the
    // root, halved with each level) is at least this, so no two points of an inner node are nearer. Leaves
    // among these levels hold the rest of their points at any distance, so they are thinned to it: in stored
    // order, a point nearer than this to one kept before, in the same node, is left out. The root's level is
    // taken even where its own spacing is smaller, and thinned likewise; so are inner nodes of clouds that
    // were sampled without a minimum distance.
    //
    // Distances are measured as the converter does: in plan where z has another unit than x and y.
    //
    // The level of detail does not depend on the other conditions: they choose among its points.
    double spacing = 0;
};

} // namespace stipple
