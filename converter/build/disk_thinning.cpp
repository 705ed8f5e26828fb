#include "converter/build/disk_thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

namespace {
constexpr double cellDistances = 4; // width of a cell, at least: measured, but 2 and 8 are hardly worse
constexpr int maxCellBits = 7;      // 2^7 cells a side at most: 128^3 heads are 8 MB

Vec3d inDouble(Vec3i p) {
    return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}
} // namespace

void DiskThinning::begin(int nodeBits, Vec3d weights, double squaredDistance,
                         std::span<const Vec3<std::uint32_t>> points) {
    const double distance = std::sqrt(squaredDistance), side = std::ldexp(1.0, nodeBits);
    weights_ = weights;
    squaredDistance_ = squaredDistance;
    points_ = points;
    for (int a = 0; a < 3; ++a)
        axes_[static_cast<std::size_t>(a)] = axisOf(nodeBits, weights[a], distance);
    // Coordinates lie within two sides of the corner. Each is rounded when it is weighted, so is the
    // difference of two: on an axis that is off by 2^-21 sides at most. Squares and their sum are off by
    // 2^-21 of themselves.
    const double largest = std::max({weights.x, weights.y, weights.z});
    const double off = std::ldexp(largest * side, -20) + std::ldexp(distance, -20);
    near_ = static_cast<float>(std::pow(std::max(0.0, distance - off), 2));
    far_ = static_cast<float>(std::pow(distance + off, 2));
    place();
}

DiskThinning::Axis DiskThinning::axisOf(int nodeBits, double weight, double distance) const {
    const double side = std::ldexp(1.0, nodeBits);
    Axis axis;
    axis.reach = static_cast<std::int64_t>(weight > 0 ? std::min(distance / weight + 1, side) : side);
    axis.shift = std::max(0, nodeBits - maxCellBits);
    while (axis.shift < nodeBits && std::ldexp(weight, axis.shift) < cellDistances * distance)
        ++axis.shift;
    axis.bits = nodeBits - axis.shift;
    return axis;
}

void DiskThinning::place() {
    // Only the cells that the last node used have to be emptied.
    for (std::size_t cell : used_)
        heads_[cell] = 0;
    used_.clear();
    runs_.clear();
    const std::size_t cells = std::size_t{1} << (axes_[0].bits + axes_[1].bits + axes_[2].bits);
    if (heads_.size() < cells)
        heads_.resize(cells, 0);
    fours_.resize(points_.size() / 4 + 1);
    nearest_.assign(fours_.size(), Floats{} + near_);
    constexpr float nowhere = std::numeric_limits<float>::infinity();
    fours_.back().x = Floats{nowhere, nowhere, nowhere, nowhere};
    std::size_t last = cells;
    for (std::uint32_t i = 0; i < points_.size(); ++i) {
        const Vec3i p{points_[i].x, points_[i].y, points_[i].z};
        const Vec3<float> q = weighted(inDouble(p));
        Four& four = fours_[i / 4];
        four.x[i % 4] = q.x;
        four.y[i % 4] = q.y;
        four.z[i % 4] = q.z;
        four.excluded[i % 4] = 0;
        const std::size_t cell =
            cellAt({p.x >> axes_[0].shift, p.y >> axes_[1].shift, p.z >> axes_[2].shift});
        if (cell == last) {
            ++runs_.back().end;
            continue;
        }
        last = cell;
        runs_.push_back({i, i + 1, heads_[cell]});
        heads_[cell] = static_cast<std::uint32_t>(runs_.size());
        used_.push_back(cell);
    }
}

Vec3<float> DiskThinning::weighted(Vec3d p) const {
    return {static_cast<float>(p.x * weights_.x), static_cast<float>(p.y * weights_.y),
            static_cast<float>(p.z * weights_.z)};
}

void DiskThinning::exclude(Vec3i p, std::uint32_t by) {
    const Vec3<float> rounded = weighted(inDouble(p));
    const auto mark = static_cast<std::int32_t>(by + markOffset);
    Flags doubt{};
    if (by == outside)
        visitRunsNear(p, [&](const Run& run) { doubt |= excludeRun<true>(run, rounded, mark); });
    else
        visitRunsNear(p, [&](const Run& run) { doubt |= excludeRun<false>(run, rounded, mark); });
    if ((doubt[0] | doubt[1] | doubt[2] | doubt[3]) != 0)
        visitRunsNear(p, [&](const Run& run) { excludeExactly(run, inDouble(p), mark); });
}

// All runs with points within reach.
template <class Visit>
void DiskThinning::visitRunsNear(Vec3i p, Visit visit) const {
    Vec3i low, high;
    for (int a = 0; a < 3; ++a) {
        const Axis& axis = axes_[static_cast<std::size_t>(a)];
        low[a] = std::max<std::int64_t>((p[a] - axis.reach) >> axis.shift, 0);
        high[a] =
            std::min<std::int64_t>((p[a] + axis.reach) >> axis.shift, (std::int64_t{1} << axis.bits) - 1);
    }
    for (std::int64_t z = low.z; z <= high.z; ++z)
        for (std::int64_t y = low.y; y <= high.y; ++y)
            for (std::int64_t x = low.x; x <= high.x; ++x)
                for (std::uint32_t at = heads_[cellAt({x, y, z})]; at > 0; at = runs_[at - 1].next)
                    visit(runs_[at - 1]);
}

// Returns for which points floats leave a doubt. Compares points beside the run, too, that share its first or
// last four.
template <bool isOutside>
DiskThinning::Flags DiskThinning::excludeRun(const Run& run, Vec3<float> p, std::int32_t mark) {
    const float nearest = near_, farthest = far_;
    Flags doubt{};
    for (Four *four = &fours_[run.begin / 4], *end = &fours_[(run.end - 1) / 4] + 1; four < end; ++four) {
        Floats x = four->x - p.x, y = four->y - p.y, z = four->z - p.z;
        Floats squared = x * x + y * y + z * z;
        doubt |= (squared >= nearest) & (squared <= farthest);
        if constexpr (isOutside) {
            Flags first = (squared < nearest) & (four->excluded == 0);
            four->excluded |= first & mark;
        } else {
            Floats& least = nearest_[static_cast<std::size_t>(four - fours_.data())];
            Flags nearer = squared < least;
            four->excluded = nearer ? Flags{} + mark : four->excluded;
            least = nearer ? squared : least;
        }
    }
    return doubt;
}

void DiskThinning::excludeExactly(const Run& run, Vec3d p, std::int32_t mark) {
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
        double x = (points_[i].x - p.x) * weights_.x, y = (points_[i].y - p.y) * weights_.y,
               z = (points_[i].z - p.z) * weights_.z;
        if (x * x + y * y + z * z < squaredDistance_)
            if (std::int32_t by = fours_[i / 4].excluded[i % 4]; by == 0 || by == outsideMark)
                fours_[i / 4].excluded[i % 4] = mark;
    }
}

} // namespace stipple
