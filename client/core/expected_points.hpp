// How many points of some nodes are likely to show with continuous detail, at any target spacing: what the
// point budget is compared with. A node's points are taken as spread evenly over cells of its box; each cell
// shows those of its share whose spacing exceeds the target at its middle, and none if that is out of the
// picture.
//
// Of a cell the share is linear in 1 / target² (continuous_detail.hpp), so all are kept as two numbers, and
// the sum over thousands of nodes is one loop for the vectorizer.
#pragma once

#include "client/core/continuous_detail.hpp"
#include "shared/geometry/box.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stipple {

class ExpectedPoints {
  public:
    // `height`: of the picture, pixels.
    ExpectedPoints(const ViewTransform& view, int height) : view_(view), height_(height) {}

    // The next node: where its points lie, how dense they are, how many the file has of it.
    void add(const BoxD& box, const RankDensity& density, std::uint32_t points);

    // Of all nodes together; `target` in pixels.
    double shownAt(double target) const;
    // Of node `index` in the order of add(), if only its first `points` are sent.
    double shownOf(std::size_t index, double target, std::uint32_t points) const;

  private:
    static constexpr int cellsAcross = 3;
    static constexpr std::size_t cells = 27, stride = 32; // rows are padded with cells that show nothing

    bool isInPicture(Vec3d fromEye) const;
    float slopeAt(Vec3d fromEye, double step) const;

    ViewTransform view_;
    int height_;
    // Points of a cell, as if all of the node's were in it: slope / target² - rest, from 0 to `most`.
    std::vector<float> slopes_; // stride for each node
    std::vector<float> rests_, most_;
};

} // namespace stipple
