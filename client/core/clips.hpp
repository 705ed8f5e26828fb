// The clip boxes and regions of a style, made ready: what they do to whole nodes and to single points. Pure;
// any thread.
//
//   selection   SelectionBuilder::inView: a node that is clipped away is neither fetched nor drawn, nor is
//               anything below it
//   paint       node_paint.hpp: of the other nodes, those that no side of a clip crosses need no test of
//               their points
//
// Exact: a point lies where Grid::toWorld() puts it, and verdicts on nodes are never wrong about a point.
#pragma once

#include "client/core/colour_style.hpp"
#include "shared/base/result.hpp"
#include "shared/select/point_region.hpp"

#include <span>
#include <vector>

namespace stipple {

struct ClipVerdict {
    bool hidden = false;      // all points in the box are hidden
    bool tested = false;      // whether a point is hidden depends on where it is
    bool highlighted = false; // a highlight may hold some of the points
};

class Clips {
  public:
    Clips() = default; // none: nothing is hidden
    // invalidArgument for boxes and regions whose numbers can't be computed with (orientedBox(), filterOf()).
    static Result<Clips> make(std::span<const ClipBox> boxes, std::span<const ClipRegion> regions = {});

    bool empty() const { return hideInside_.empty() && hideOutside_.empty() && highlight_.empty(); }
    bool hidesPoints() const { return !hideInside_.empty() || !hideOutside_.empty(); }
    // Of points that lie in `box`, world units.
    ClipVerdict clipVerdict(const BoxD& box) const;
    // Only what says something about points in `box`.
    Clips near(const BoxD& box) const;

    bool hides(Vec3d point) const;
    bool highlights(Vec3d point) const;

  private:
    Status add(const RegionShape& shape, ClipMode mode);
    std::vector<PointRegion> hideInside_, hideOutside_, highlight_;
};

} // namespace stipple
