// A picture from first principles: every point in double precision, from its world coordinates, pixel by
// pixel, sharing no arithmetic with the renderers. It also says where it can't be sure: pixels whose winner
// would change if a point moved by `slackPixels`, grew by as much, or two points' distances by
// `slackDistance` (relative).
#pragma once

#include "client/render/image.hpp"
#include "tests/support/test_plan.hpp"

#include <cstdint>
#include <vector>

namespace stipple::test {

struct ReferenceSlack {
    double pixels = 0.01;
    double distance = 4e-6; // 2^-18, the coarsest depth step of a range of 32 octaves
};

struct ReferencePicture {
    Image image;
    std::vector<bool> unsure;      // per pixel, rows from the top
    std::vector<double> distances; // view distance; 0 where there is no point
};

ReferencePicture referencePicture(const std::vector<TestNode>& nodes, const TestView& view,
                                  const Style& style, const ReferenceSlack& slack = {});

// How two pictures of one size differ.
struct PictureDifference {
    int largest = 0;        // levels, any channel
    double mean = 0;        // levels, over all channels and pixels
    std::size_t pixels = 0; // with a channel further apart than the tolerance
};
PictureDifference difference(const Image& a, const Image& b, int toleranceLevels);

// Differing pixels that `reference` is sure of.
std::size_t wrongPixels(const Image& image, const ReferencePicture& reference, int toleranceLevels);

} // namespace stipple::test
