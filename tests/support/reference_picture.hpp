// The reference renderer (client/reference) on nodes that a test makes by hand. It also says where it can't
// be sure: pixels that would show another point if points were a little elsewhere (reference::Slack).
#pragma once

#include "client/measure/pixel_error.hpp"
#include "client/reference/canvas.hpp"
#include "tests/support/test_plan.hpp"

#include <vector>

namespace stipple::test {

struct ReferencePicture {
    DepthImage picture;
    std::vector<bool> unsure; // per pixel, rows from the top
};

ReferencePicture referencePicture(const std::vector<TestNode>& nodes, const TestView& view,
                                  const Style& style, int samples = 1, const reference::Slack& slack = {});

// Differing pixels that `reference` is sure of.
std::size_t wrongPixels(const Image& image, const ReferencePicture& reference, int toleranceLevels);
// The same of view distances, which must agree to a depth step.
std::size_t wrongDistances(const std::vector<float>& distances, const ReferencePicture& reference);

} // namespace stipple::test
