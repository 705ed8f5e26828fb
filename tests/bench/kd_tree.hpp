// Exact nearest neighbours among points in memory (k-d tree; J. L. Bentley 1975): the points themselves,
// ordered so that the middle one of a range parts it along the axis where the range is widest.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace stipple::bench {

struct TreePoint {
    Vec3d at;
    std::uint32_t node = 0; // a mark of the caller's
};

class KdTree {
  public:
    explicit KdTree(std::vector<TreePoint> points) : points_(std::move(points)), axes_(points_.size()) {
        arrange(0, points_.size());
    }
    const std::vector<TreePoint>& points() const { return points_; }

    static constexpr std::size_t none = ~std::size_t{0};
    // Squared distance of the nearest point but `self`; infinite if there is none.
    double squaredToNearest(Vec3d p, std::size_t self = none) const {
        double best = std::numeric_limits<double>::infinity();
        visit(0, points_.size(), p, best, [&](std::size_t i, double squared) {
            if (i != self)
                best = std::min(best, squared);
        });
        return best;
    }
    // Calls found(index, squared distance) for the points at most `squared` away, and for others.
    template <class Found>
    void around(Vec3d p, double squared, Found found) const {
        visit(0, points_.size(), p, squared, found);
    }

  private:
    static constexpr std::size_t leafPoints = 8;

    void arrange(std::size_t begin, std::size_t end) {
        if (end - begin <= leafPoints)
            return;
        Vec3d low = points_[begin].at, high = low;
        for (std::size_t i = begin; i < end; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                low[axis] = std::min(low[axis], points_[i].at[axis]);
                high[axis] = std::max(high[axis], points_[i].at[axis]);
            }
        Vec3d wide = high - low;
        int axis = wide.x >= wide.y && wide.x >= wide.z ? 0 : wide.y >= wide.z ? 1 : 2;
        std::size_t middle = begin + (end - begin) / 2;
        auto at = [&](std::size_t i) { return points_.begin() + static_cast<std::ptrdiff_t>(i); };
        std::nth_element(at(begin), at(middle), at(end),
                         [axis](const TreePoint& a, const TreePoint& b) { return a.at[axis] < b.at[axis]; });
        axes_[middle] = static_cast<std::uint8_t>(axis);
        arrange(begin, middle);
        arrange(middle + 1, end);
    }

    // `limit` may shrink while it goes on.
    template <class Found>
    void visit(std::size_t begin, std::size_t end, Vec3d p, const double& limit, const Found& found) const {
        auto look = [&](std::size_t i) { found(i, dot(points_[i].at - p, points_[i].at - p)); };
        if (end - begin <= leafPoints) {
            for (std::size_t i = begin; i < end; ++i)
                look(i);
            return;
        }
        std::size_t middle = begin + (end - begin) / 2;
        look(middle);
        double apart = p[axes_[middle]] - points_[middle].at[axes_[middle]];
        bool upper = apart > 0;
        upper ? visit(middle + 1, end, p, limit, found) : visit(begin, middle, p, limit, found);
        if (apart * apart <= limit)
            upper ? visit(begin, middle, p, limit, found) : visit(middle + 1, end, p, limit, found);
    }

    std::vector<TreePoint> points_;
    std::vector<std::uint8_t> axes_;
};

} // namespace stipple::bench
