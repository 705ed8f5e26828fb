#include "client/survey/volumes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple::survey {

namespace {

// Squared distance of p from the segment a, b.
double squareTo(Point2d p, Point2d a, Point2d b) {
    double dx = b.x - a.x, dy = b.y - a.y, square = dx * dx + dy * dy;
    double t = square > 0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / square, 0.0, 1.0) : 0;
    double x = a.x + t * dx - p.x, y = a.y + t * dy - p.y;
    return x * x + y * y;
}

} // namespace

Result<Base> Base::plane(const Plane& plane, const Directions& directions) {
    double rise = directions.height(plane.normal);
    if (!(std::abs(rise) > 1e-9))
        return Error{ErrorCode::invalidArgument, say("an upright plane has no side above it"), "",
                     say("choose a base that is not upright")};
    Point2d normal = directions.plan(plane.normal), at = directions.plan(plane.at);
    Facet facet;
    facet.slopeX = -normal.x / rise;
    facet.slopeY = -normal.y / rise;
    facet.atZero = directions.height(plane.at) - facet.slopeX * at.x - facet.slopeY * at.y;
    Base base;
    base.facets_.push_back(facet);
    return base;
}

Result<Base> Base::rim(std::span<const Vec3d> corners, const Directions& directions) {
    std::vector<Point2d> plan;
    for (Vec3d corner : corners)
        plan.push_back(directions.plan(corner));
    STIPPLE_TRY(triangles, triangulate(plan));
    Base base;
    for (const Triangle& t : triangles) {
        Vec3d normal = cross(corners[t[1]] - corners[t[0]], corners[t[2]] - corners[t[0]]);
        STIPPLE_TRY(part, Base::plane({corners[t[0]], normalized(normal)}, directions));
        Facet facet = part.facets_.front();
        facet.a = plan[t[0]];
        facet.b = plan[t[1]];
        facet.c = plan[t[2]];
        facet.corners = t;
        base.facets_.push_back(facet);
    }
    base.supports_ = corners.size();
    return base;
}

const Base::Facet& Base::facetAt(Point2d plan) const {
    const Facet* nearest = &facets_.front();
    double least = std::numeric_limits<double>::infinity();
    for (const Facet& facet : facets_) {
        if (facets_.size() == 1 || triangleHolds(facet.a, facet.b, facet.c, plan)) {
            nearest = &facet;
            break;
        }
        double square = std::min({squareTo(plan, facet.a, facet.b), squareTo(plan, facet.b, facet.c),
                                  squareTo(plan, facet.c, facet.a)});
        if (square < least) {
            least = square;
            nearest = &facet;
        }
    }
    return *nearest;
}

double Base::heightAt(Point2d plan) const {
    const Facet& facet = facetAt(plan);
    return facet.atZero + facet.slopeX * plan.x + facet.slopeY * plan.y;
}

// Barycentric coordinates.
std::vector<Base::Share> Base::sharesAt(Point2d plan) const {
    if (supports_ == 1)
        return {{0, 1}};
    const Facet& facet = facetAt(plan);
    auto twice = [](Point2d a, Point2d b, Point2d c) {
        return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    };
    double whole = twice(facet.a, facet.b, facet.c);
    double first = twice(plan, facet.b, facet.c) / whole, second = twice(facet.a, plan, facet.c) / whole;
    return {{facet.corners[0], first}, {facet.corners[1], second}, {facet.corners[2], 1 - first - second}};
}

CutFillMeasure::CutFillMeasure(std::vector<Point2d> plan, Base base, const Directions& directions)
    : plan_(std::move(plan)), region_({Polygon{Ring(plan_), {}}}), base_(std::move(base)),
      directions_(directions) {}

Result<CutFillMeasure> CutFillMeasure::make(std::span<const Vec3d> corners, Base base, double cell,
                                            const Directions& directions) {
    if (!(cell > 0 && std::isfinite(cell)))
        return Error{ErrorCode::invalidArgument, say("cells of a volume need a side above 0"), "", ""};
    std::vector<Point2d> plan;
    for (Vec3d corner : corners)
        plan.push_back(directions.plan(corner));
    STIPPLE_CHECK(triangulate(plan)); // has an area, and no edges that cross
    CutFillMeasure measure(std::move(plan), std::move(base), directions);
    const BoxD& bounds = measure.region_.bounds();
    double columns = std::ceil((bounds.max.x - bounds.min.x) / cell);
    double rows = std::ceil((bounds.max.y - bounds.min.y) / cell);
    if (!(columns * rows <= static_cast<double>(maxCells)))
        return Error{ErrorCode::limitExceeded, say("the polygon has too many cells of that size"), "",
                     say("choose larger cells or a smaller polygon")};
    measure.lowest_ = {bounds.min.x, bounds.min.y};
    measure.cell_ = cell;
    measure.columns_ = static_cast<std::size_t>(std::max(columns, 1.0));
    measure.rows_ = static_cast<std::size_t>(std::max(rows, 1.0));
    measure.cells_.resize(measure.columns_ * measure.rows_);
    return measure;
}

Point2d CutFillMeasure::cornerOf(std::size_t column, std::size_t row) const {
    return {lowest_.x + cell_ * static_cast<double>(column), lowest_.y + cell_ * static_cast<double>(row)};
}

double CutFillMeasure::areaInside(std::size_t column, std::size_t row) const {
    Point2d low = cornerOf(column, row), high = cornerOf(column + 1, row + 1);
    Overlap overlap = region_.overlapOf({{low.x, low.y, 0}, {high.x, high.y, 0}});
    if (overlap == Overlap::none)
        return 0;
    return overlap == Overlap::whole ? cell_ * cell_ : std::abs(signedArea(clipToBox(plan_, low, high)));
}

void CutFillMeasure::add(Vec3d point) {
    Point2d plan = directions_.plan(point);
    if (!region_.contains(plan))
        return;
    auto place = [this](double from, std::size_t count) {
        return std::min(static_cast<std::size_t>(std::max(from / cell_, 0.0)), count - 1);
    };
    Cell& cell = cells_[place(plan.y - lowest_.y, rows_) * columns_ + place(plan.x - lowest_.x, columns_)];
    double height = directions_.height(point) - base_.heightAt(plan);
    ++points_;
    ++cell.count; // Welford, "Note on a Method for Calculating Corrected Sums of Squares", 1962
    double away = height - cell.mean;
    cell.mean += away / cell.count;
    cell.squares += away * (height - cell.mean);
}

// Of every cell: its own, or the mean of those of its eight neighbours that got one in an earlier round.
std::vector<double> CutFillMeasure::filledHeights() const {
    std::vector<double> heights(cells_.size());
    std::vector<std::uint32_t> roundOf(cells_.size(), 0); // 0: none yet
    std::vector<std::size_t> front, next;
    for (std::size_t i = 0; i < cells_.size(); ++i)
        if (cells_[i].count > 0) {
            heights[i] = cells_[i].mean;
            roundOf[i] = 1;
            front.push_back(i);
        }
    auto visitNeighbours = [this](std::size_t i, const auto& visit) {
        std::size_t column = i % columns_, row = i / columns_;
        for (std::size_t r = row - (row > 0); r <= std::min(row + 1, rows_ - 1); ++r)
            for (std::size_t c = column - (column > 0); c <= std::min(column + 1, columns_ - 1); ++c)
                if (std::size_t other = r * columns_ + c; other != i)
                    visit(other);
    };
    for (std::uint32_t round = 2; !front.empty(); ++round, front.swap(next)) {
        next.clear();
        for (std::size_t i : front)
            visitNeighbours(i, [&](std::size_t other) {
                if (roundOf[other] == 0) {
                    roundOf[other] = round;
                    next.push_back(other);
                }
            });
        for (std::size_t i : next) {
            double sum = 0;
            int count = 0;
            visitNeighbours(i, [&](std::size_t other) {
                if (roundOf[other] > 0 && roundOf[other] < round) {
                    sum += heights[other];
                    ++count;
                }
            });
            heights[i] = sum / count;
        }
    }
    return heights;
}

Result<CutFill> CutFillMeasure::result() const {
    if (points_ == 0)
        return Error{ErrorCode::notFound, say("the polygon holds no point"), "",
                     say("draw it where the cloud has points")};
    std::vector<double> heights = filledHeights();
    CutFill total;
    total.points = points_;
    double cutVariance = 0, fillVariance = 0;
    total.cutShares.resize(base_.supports());
    total.fillShares.resize(base_.supports());
    for (std::size_t row = 0; row < rows_; ++row)
        for (std::size_t column = 0; column < columns_; ++column) {
            std::size_t i = row * columns_ + column;
            double area = areaInside(column, row);
            total.area += area;
            if (area == 0)
                continue;
            bool isCut = heights[i] > 0;
            (isCut ? total.cut : total.fill) += area * std::abs(heights[i]);
            Point2d low = cornerOf(column, row);
            for (Base::Share share : base_.sharesAt({low.x + cell_ / 2, low.y + cell_ / 2}))
                (isCut ? total.cutShares : total.fillShares)[share.support] += area * share.share;
            if (const Cell& cell = cells_[i]; cell.count == 0)
                total.areaWithoutPoints += area;
            else if (cell.count > 1)
                (isCut ? cutVariance : fillVariance) +=
                    area * area * cell.squares / (cell.count - 1.0) / cell.count;
        }
    total.cutDeviation = std::sqrt(cutVariance);
    total.fillDeviation = std::sqrt(fillVariance);
    total.deviation = std::sqrt(cutVariance + fillVariance);
    return total;
}

} // namespace stipple::survey
