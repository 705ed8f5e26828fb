// Draws a frame plan on the CPU. Same picture as GlesRenderer within the tolerance that
// tests/unit/client/render states; some fifty times faster than a GL in software.
#pragma once

#include "client/core/frame_plan.hpp"
#include "client/render/image.hpp"
#include "client/render/pick.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace stipple {

class SoftwareRenderer {
  public:
    // `threads` 0: one per core.
    static std::unique_ptr<SoftwareRenderer> create(int threads = 0);
    virtual ~SoftwareRenderer() = default;

    // Draws the plan's part. Adds to plan.counters: passesRun, passesSkipped, nodesOutsidePart. The picture
    // and all buffers are kept until the next call. A plan that is not drawable (raster_setup.hpp), or whose
    // part is more than maxPartSide long, gives an empty picture.
    virtual const Image& render(FramePlan& plan) = 0;

    // Of the last picture: the view distance of each pixel's point, rows from top to bottom; 0 where there is
    // none, and everywhere after pick().
    virtual std::vector<float> distances() const = 0;

    // The point that the pointer is on, in the picture that render() would draw of the plan; none if no pixel
    // near enough shows one. Draws only what can be there, and no colours.
    virtual std::optional<PickHit> pick(const FramePlan& plan, const PickRequest& request) = 0;
};

} // namespace stipple
