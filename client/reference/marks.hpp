// Points to marks on a picture: where, how large, in which colour. One function for each thing a style says.
#pragma once

#include "client/core/style.hpp"
#include "client/reference/view.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/points/point_batch.hpp"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace stipple::reference {

// Points of one cloud, exact: grid integers and the columns of `attributes`.
struct Points {
    const Grid* grid = nullptr;
    const PointBatch* batch = nullptr;
    std::vector<Attribute> attributes; // parallel to batch->columns
    bool colourIs8Bit = false;         // see CloudMetadata
    std::uint64_t firstOrder = 0;      // of the batch's first point; no two points have one order
    // Per point: spacing of the finest node that holds it, world units. Needed for adaptive sizes alone.
    std::vector<double> spacings;
    // Of the node that the batch is, in progressive order.
    int level = 0;
    double nodePoints = 1;
    // Of a leaf: by how many points of the level above, on the same area, its own are more dense with each of
    // them; 0: as in any other node (reference/leaf_densities.hpp). For levels of points.
    double leafStep = 0;
};

// Levels 0..255, not rounded.
using Colour = std::array<float, 3>;

struct Mark {
    double x = 0, y = 0;     // pixels from the top left corner
    double distance = 0;     // view distance
    double diameter = 1;     // pixels
    std::uint64_t order = 0; // of two equally near marks the one of smaller order is in front
    Colour colour{};
    double unitsPerPixel = 0; // world units that a pixel spans at that distance
    // Discs: perpendicular to it, in the camera's axes (right, up, forward), of length 1; zero: the disc
    // faces the camera. And the ray of the point: slopes against `forward`, and by how much they change from
    // pixel to pixel; zero in orthographic views.
    Vec3d normal{};
    double rayX = 0, rayY = 0, slopePerPixel = 0;
    double near = 0, far = std::numeric_limits<double>::infinity(); // of the view
};

// No pixel that is farther from its point shows a disc.
inline constexpr double mostDiscReach = 127.5;

// Names of the attributes that the colours of a style need of a cloud; those it lacks are left out.
std::vector<std::string_view> neededAttributes(const Style& style, const CloudMetadata& metadata);

// Diameter in pixels of a point that far away; `spacing` as in Points::spacings.
double diameterOf(const Style& style, const View& view, double distance, double spacing = 0);

// Colours of all points. `style` has ranges (min < max). A cloud without the attribute is light grey, and so
// is a point without a value.
std::vector<Colour> coloursOf(const Style& style, const Points& points);

// Which points filters, hidden classes and clip boxes leave (reference/hiding.cpp).
std::vector<bool> shownOf(const Style& style, const Points& points);
// Tints what lies in highlight boxes.
void highlight(const Style& style, const Points& points, std::vector<Colour>& colours);

// Column of the attribute of that name, upper or lower case; -1: none.
int columnOf(const Points& points, std::string_view name);
// What a value means (offset + scale × stored; the first component); NaN for "no value".
double meaningOf(const Points& points, int column, std::size_t i);
Vec3l worldOf(const Points& points, std::size_t i);

// Appends the marks of the points that may touch the picture.
void appendMarks(const View& view, const Style& style, const Points& points, std::vector<Mark>& marks);

} // namespace stipple::reference
