// The colour of every point of a node, or that it is hidden, as a style has it: decided once, here, when a
// node, its attributes or the style change, and not frame by frame. The rasterizers and picking take what
// was decided, so a point that is not drawn is not picked either, and both renderers agree to the bit.
//
// Pure; any thread.
#pragma once

#include "client/core/clips.hpp"
#include "client/core/colour_style.hpp"
#include "client/core/node_columns.hpp"
#include "client/core/rank_density.hpp"
#include "client/core/resident_node.hpp"
#include "shared/geometry/grid.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stipple {

// What has no value of the kind that is shown: R | G << 8 | B << 16 | 255 << 24.
inline constexpr std::uint32_t plainColourWord = 0xFFB4B4B4;

struct NodePaint {
    std::uint64_t id = 0; // unique among paints and ResidentNodes; key of GPU buffers
    // A point each, of all that are resident: R | G << 8 | B << 16 | A << 24; A is 0 for hidden points, else
    // 255.
    std::shared_ptr<const std::vector<std::uint32_t>> words;
    std::uint32_t hidden = 0; // points

    bool shows(std::size_t point) const { return ((*words)[point] >> 24) != 0; }
    std::uint64_t sizeBytes() const { return sizeof *this + 4 * words->size(); }
};

// A node to paint.
struct PaintedNode {
    std::shared_ptr<const ResidentNode> node;
    std::span<const std::shared_ptr<const NodeColumns>> columns; // attributes, of at least its points
    Vec3i corner;                                                // of the node, grid integers
    BoxD box;                                                    // that its points lie in, world units
    // Nothing that it shows is coarse: points in their own colours, where `columns` has them.
    bool exact = false;
    // Of its points by rank, and the spacing of the root: what levels come from with continuous detail, as
    // the choice of points does.
    RankDensity density;
    double rootSpacing = 1;
};

class Painter {
  public:
    // `style` is resolved (resolvedStyle()); all but `continuous` (detail: levels are of points, not of
    // nodes) are borrowed.
    Painter(const ColourStyle& style, const Clips& clips, const Schema& schema, const Grid& grid,
            bool colourIs8Bit, bool continuous)
        : style_(style), clips_(clips), schema_(schema), grid_(grid), colourIs8Bit_(colourIs8Bit),
          continuous_(continuous) {}

    // Null: the node is drawn as it is, in its colour words or, without any, plain.
    std::shared_ptr<const NodePaint> paint(const PaintedNode& node) const;

    // What an attribute of the schema (its index) means of each point: as colours and filters take it. Empty:
    // the node has no such values, or `attribute` is -1.
    std::vector<double> attributeValues(const PaintedNode& node, int attribute) const;

  private:
    using Words = std::vector<std::uint32_t>;
    // Distances of values from the start of a range; NaN: no value. Empty: there are no such values.
    std::vector<double> values(const PaintedNode& node, ColourMode mode, const std::string& attribute,
                               double from) const;
    std::vector<double> elevations(const PaintedNode& node, double from) const;
    std::vector<double> levels(const PaintedNode& node) const;
    Words ownWords(const PaintedNode& node) const;
    Words classWords(const PaintedNode& node) const;
    // Empty: the cloud has nothing of that kind.
    Words colours(const PaintedNode& node, ColourMode mode, const std::string& attribute,
                  const Range& range) const;
    Words mixed(const PaintedNode& node) const;
    const Range& rangeOf(ColourMode mode) const;
    void applyFilters(const PaintedNode& node, Words& words) const;
    void applyClips(const PaintedNode& node, Words& words) const;
    bool changesPoints(const PaintedNode& node) const;

    const ColourStyle& style_;
    const Clips& clips_;
    const Schema& schema_;
    const Grid& grid_;
    bool colourIs8Bit_, continuous_;
};

// Whether `value` of an attribute passes: not NaN, and in the range but for what rounding of scaled integers
// may have moved it.
bool passes(const AttributeFilter& filter, const Attribute& attribute, double value);

} // namespace stipple
