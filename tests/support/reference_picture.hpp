// The reference renderer (client/reference) on nodes that a test makes by hand. It also says where it can't
// be sure: pixels that would show another point if points were a little elsewhere (reference::Slack).
#pragma once

#include "client/measure/pixel_error.hpp"
#include "client/reference/canvas.hpp"
#include "client/render/pick.hpp"
#include "tests/support/test_plan.hpp"

#include <optional>
#include <span>
#include <vector>

namespace stipple::test {

struct ReferencePicture {
    DepthImage picture;
    std::vector<bool> unsure;          // per pixel, rows from the top
    std::vector<double> distanceSlack; // Canvas::distanceSlack
};

ReferencePicture referencePicture(const std::vector<TestNode>& nodes, const TestView& view,
                                  const Style& style, int samples = 1, const reference::Slack& slack = {});

// Which point each pixel shows, by the reference renderer.
struct ReferencePoints {
    int width = 0, height = 0;
    std::vector<std::uint32_t> order; // Points::firstOrder + index, plus 1; 0: none. Rows from the top
    std::vector<float> distances;
    std::vector<bool> unsure;
};
// Orders must stay under 2^24 - 1. `style`: sizes and shape.
ReferencePoints referencePoints(const reference::View& view, const Style& style,
                                std::span<const reference::Points> clouds);
ReferencePoints referencePoints(const std::vector<TestNode>& nodes, const TestView& view, const Style& style);

// What a pick is expected to answer, by looking at every pixel within the radius: an order as above, 0 for no
// point; and whether the reference is sure of it.
struct ExpectedPick {
    std::uint32_t order = 0;
    bool isSure = true;
};
ExpectedPick expectedPick(const ReferencePoints& points, const PickRequest& request);
// What was picked, as such an order: the plan's points are counted in the order of its nodes.
std::uint32_t orderOf(const std::optional<PickHit>& hit, const FramePlan& plan);

// Differing pixels that `reference` is sure of.
std::size_t wrongPixels(const Image& image, const ReferencePicture& reference, int toleranceLevels);
// The same of view distances, which must agree to a depth step.
std::size_t wrongDistances(const std::vector<float>& distances, const ReferencePicture& reference);

} // namespace stipple::test
