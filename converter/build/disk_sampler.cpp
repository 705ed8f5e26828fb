#include "converter/build/disk_sampler.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {
constexpr int maxCellBits = 7; // 2^7 cells a side at most: 130^3 heads are 9 MB
}

void DiskSampler::begin(int nodeBits, Vec3d weights, double squaredDistance) {
    weights_ = weights;
    squaredDistance_ = squaredDistance;
    double width = 2 * std::sqrt(squaredDistance);
    std::size_t cells = 1;
    for (int a = 0; a < 3; ++a) {
        Axis& axis = axes_[static_cast<std::size_t>(a)];
        axis.shift = std::max(0, nodeBits - maxCellBits);
        while (axis.shift < nodeBits && std::ldexp(weights[a], axis.shift) < width)
            ++axis.shift;
        axis.looksBoth = std::ldexp(weights[a], axis.shift) < width;
        axis.cells = (std::int32_t{1} << (nodeBits - axis.shift)) + 2;
        cells *= static_cast<std::size_t>(axis.cells);
    }
    // Only the cells that the last node used have to be emptied.
    for (std::size_t cell : used_)
        heads_[cell] = -1;
    used_.clear();
    accepted_.clear();
    if (heads_.size() < cells)
        heads_.resize(cells, -1);
}

std::int32_t DiskSampler::cellOf(std::int64_t coordinate, const Axis& axis) const {
    std::int64_t cell = (coordinate >> axis.shift) + 1;
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(cell, 0, axis.cells - 1));
}

bool DiskSampler::isNear(std::size_t cell, Vec3d p) const {
    for (std::int32_t at = heads_[cell]; at >= 0;) {
        const Accepted& other = accepted_[static_cast<std::size_t>(at)];
        double dx = (p.x - other.x) * weights_.x;
        double dy = (p.y - other.y) * weights_.y;
        double dz = (p.z - other.z) * weights_.z;
        if (dx * dx + dy * dy + dz * dz < squaredDistance_)
            return true;
        at = other.next;
    }
    return false;
}

void DiskSampler::insert(std::size_t cell, Vec3d p) {
    if (heads_[cell] < 0)
        used_.push_back(cell);
    accepted_.push_back({p.x, p.y, p.z, heads_[cell]});
    heads_[cell] = static_cast<std::int32_t>(accepted_.size() - 1);
}

bool DiskSampler::accept(Vec3<std::int64_t> p) {
    std::array<std::array<std::int32_t, 3>, 3> cells; // per axis: its own, then those to look into
    std::array<int, 3> counts;
    for (int a = 0; a < 3; ++a) {
        const Axis& axis = axes_[static_cast<std::size_t>(a)];
        auto& list = cells[static_cast<std::size_t>(a)];
        list[0] = cellOf(p[a], axis);
        bool upperHalf = axis.shift > 0 && ((p[a] >> (axis.shift - 1)) & 1) != 0;
        list[1] = list[0] + (upperHalf ? 1 : -1);
        list[2] = list[0] + (upperHalf ? -1 : 1);
        // Cells of one step hold no halves.
        counts[static_cast<std::size_t>(a)] = axis.looksBoth || axis.shift == 0 ? 3 : 2;
    }
    auto index = [&](int x, int y, int z) {
        return (static_cast<std::size_t>(cells[2][static_cast<std::size_t>(z)]) *
                    static_cast<std::size_t>(axes_[1].cells) +
                static_cast<std::size_t>(cells[1][static_cast<std::size_t>(y)])) *
                   static_cast<std::size_t>(axes_[0].cells) +
               static_cast<std::size_t>(cells[0][static_cast<std::size_t>(x)]);
    };
    Vec3d point{static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
    for (int z = 0; z < counts[2]; ++z)
        for (int y = 0; y < counts[1]; ++y)
            for (int x = 0; x < counts[0]; ++x)
                if (isNear(index(x, y, z), point))
                    return false;
    insert(index(0, 0, 0), point);
    return true;
}

void DiskSampler::block(Vec3<std::int64_t> p) {
    std::size_t cell =
        (static_cast<std::size_t>(cellOf(p.z, axes_[2])) * static_cast<std::size_t>(axes_[1].cells) +
         static_cast<std::size_t>(cellOf(p.y, axes_[1]))) *
            static_cast<std::size_t>(axes_[0].cells) +
        static_cast<std::size_t>(cellOf(p.x, axes_[0]));
    insert(cell, {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)});
}

} // namespace stipple
