// Cut and fill: what lies above and below a base within a polygon (a heap, a pit, a levelled site), from all
// the cloud's points there. Points come in any order and in any number; nothing is kept of them but sums a
// cell.
//
// The plan is dealt into square cells. Of each the part inside the polygon is taken exactly; its height is
// the mean of its points' heights above the base, so a slope that the base shares costs nothing. Cells
// without a point (a hole in the scan) get theirs from their neighbours, and the result says how much that
// is.
#pragma once

#include "client/survey/areas.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/plan_polygon.hpp"
#include "shared/geometry/polygon.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stipple::survey {

// The surface that heights are taken from.
class Base {
  public:
    // Errors: invalidArgument for a plane that is upright.
    static Result<Base> plane(const Plane& plane, const Directions& directions = {});
    // Triangles through the polygon's own corners, at their heights: what was there before the heap, as far
    // as its rim tells. Errors: as triangulate().
    static Result<Base> rim(std::span<const Vec3d> corners, const Directions& directions = {});

    // Above the first point of the cloud's local coordinates; beyond the rim's triangles as the nearest one.
    double heightAt(Point2d plan) const;

    // By how much the base rises there if one of its supports does by one: a rim's corners, of a plane its
    // whole. The shares of a place add up to 1.
    struct Share {
        std::size_t support = 0;
        double share = 1;
    };
    std::vector<Share> sharesAt(Point2d plan) const;
    std::size_t supports() const { return supports_; }

  private:
    struct Facet { // height = atZero + slopeX × x + slopeY × y
        Point2d a, b, c;
        double atZero = 0, slopeX = 0, slopeY = 0;
        Triangle corners{};
    };
    const Facet& facetAt(Point2d plan) const;

    std::vector<Facet> facets_; // one without corners: a plane
    std::size_t supports_ = 1;
};

struct CutFill {
    double cut = 0;               // above the base, >= 0
    double fill = 0;              // below it, >= 0
    double area = 0;              // of the polygon, in plan
    double areaWithoutPoints = 0; // of it: in cells that have none
    double deviation = 0;         // standard deviation of cut - fill, from how heights scatter within cells
    double cutDeviation = 0, fillDeviation = 0; // the same of each
    // By how much cut falls and fill rises if a support of the base rises by one (Base::sharesAt): areas.
    std::vector<double> cutShares, fillShares;
    std::uint64_t points = 0; // inside the polygon
    double net() const { return cut - fill; }
};

class CutFillMeasure {
  public:
    static constexpr std::size_t maxCells = std::size_t{1} << 24;

    // `cell`: side of the cells; good is twice the distance of the points. Errors: invalidArgument for a
    // polygon without area or whose edges cross, a cell that is not > 0; limitExceeded for more than
    // maxCells.
    static Result<CutFillMeasure> make(std::span<const Vec3d> corners, Base base, double cell,
                                       const Directions& directions = {});

    void add(Vec3d point); // local as the corners; points outside the polygon count nothing
    // Errors: notFound if no point was inside.
    Result<CutFill> result() const;

  private:
    struct Cell {
        std::uint32_t count = 0;
        double mean = 0, squares = 0; // of heights above the base; of their differences from the mean
    };
    CutFillMeasure(std::vector<Point2d> plan, Base base, const Directions& directions);
    std::vector<double> filledHeights() const;
    Point2d cornerOf(std::size_t column, std::size_t row) const;
    double areaInside(std::size_t column, std::size_t row) const; // of a cell: in the polygon

    std::vector<Point2d> plan_;
    PolygonRegion region_;
    Base base_;
    Directions directions_;
    Point2d lowest_;
    double cell_ = 1;
    std::size_t columns_ = 0, rows_ = 0;
    std::vector<Cell> cells_;
    std::uint64_t points_ = 0;
};

} // namespace stipple::survey
