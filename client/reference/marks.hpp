// Points to marks on a picture: where, how large, in which colour. One function for each thing a style says.
#pragma once

#include "client/core/style.hpp"
#include "client/reference/view.hpp"
#include "shared/format/cloud_metadata.hpp"
#include "shared/points/point_batch.hpp"

#include <array>
#include <cstdint>
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
};

// Names of the attributes that the colours of a style need of a cloud; those it lacks are left out.
std::vector<std::string_view> neededAttributes(const Style& style, const CloudMetadata& metadata);

// Diameter in pixels of a point that far away; `spacing` as in Points::spacings.
double diameterOf(const Style& style, const View& view, double distance, double spacing = 0);

// Colours of all points. `style` has ranges (min < max). A cloud without the attribute is light grey.
std::vector<Colour> coloursOf(const Style& style, const Points& points);

// Appends the marks of the points that may touch the picture.
void appendMarks(const View& view, const Style& style, const Points& points, std::vector<Mark>& marks);

} // namespace stipple::reference
