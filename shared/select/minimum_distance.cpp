#include "shared/select/minimum_distance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {

constexpr std::uint32_t none = 0xFFFFFFFF;

// Cells as wide as the distance, in a hash table of chains: points nearer than it lie in a cell or the 26
// around it.
class Cells {
  public:
    explicit Cells(std::size_t points)
        : heads_(std::bit_ceil(points + points / 2 + 1), none), next_(points, none) {}

    std::uint32_t first(Vec3i cell) const { return heads_[slotOf(cell)]; }
    std::uint32_t after(std::uint32_t point) const { return next_[point]; }
    void add(Vec3i cell, std::uint32_t point) {
        std::uint32_t& head = heads_[slotOf(cell)];
        next_[point] = head;
        head = point;
    }

  private:
    std::size_t slotOf(Vec3i cell) const {
        std::uint64_t h = static_cast<std::uint64_t>(cell.x) * 0x9E3779B97F4A7C15ull;
        h = (h ^ (h >> 32) ^ static_cast<std::uint64_t>(cell.y)) * 0xBF58476D1CE4E5B9ull;
        h = (h ^ (h >> 29) ^ static_cast<std::uint64_t>(cell.z)) * 0x94D049BB133111EBull;
        return static_cast<std::size_t>(h ^ (h >> 31)) & (heads_.size() - 1);
    }
    std::vector<std::uint32_t> heads_, next_;
};

// Of the axes that count; 0 if none does.
double leastStep(Vec3d scale) {
    double least = 0;
    for (int axis = 0; axis < 3; ++axis)
        if (scale[axis] > 0 && (least == 0 || scale[axis] < least))
            least = scale[axis];
    return least;
}

} // namespace

Result<std::vector<std::uint32_t>> thinned(std::span<const Vec3i> points, Vec3i corner, Vec3d scale,
                                           double distance, const WorkGate* gate) {
    auto metric = [&](Vec3i p) {
        return Vec3d{static_cast<double>(p.x) * scale.x, static_cast<double>(p.y) * scale.y,
                     static_cast<double>(p.z) * scale.z};
    };
    // Cells a little wider than the distance, so that rounding puts no near pair two cells apart; and no
    // narrower than a grid step, below which only equal points are near, or far points would share the last
    // cell. (Past 2^62 they do, where one axis has steps 2^10 times as long as another's.)
    double cellsPerUnit = (1 - 0x1p-20) / std::max(distance, leastStep(scale));
    auto cellOf = [&](Vec3d at) {
        auto index = [&](double value) {
            return static_cast<std::int64_t>(std::floor(std::min(value * cellsPerUnit, 0x1p62)));
        };
        return Vec3i{index(at.x), index(at.y), index(at.z)};
    };
    Cells cells(points.size());
    double least = distance * distance;
    auto isFree = [&](Vec3i p, Vec3i cell) {
        for (std::int64_t z = cell.z - 1; z <= cell.z + 1; ++z)
            for (std::int64_t y = cell.y - 1; y <= cell.y + 1; ++y)
                for (std::int64_t x = cell.x - 1; x <= cell.x + 1; ++x)
                    for (std::uint32_t i = cells.first({x, y, z}); i != none; i = cells.after(i)) {
                        Vec3d apart = metric(points[i] - p);
                        if (dot(apart, apart) < least)
                            return false;
                    }
        return true;
    };
    std::vector<std::uint32_t> kept;
    STIPPLE_CHECK(inPieces(gate, points.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            Vec3i cell = cellOf(metric(points[i] - corner));
            if (!isFree(points[i], cell))
                continue;
            cells.add(cell, static_cast<std::uint32_t>(i));
            kept.push_back(static_cast<std::uint32_t>(i));
        }
    }));
    return kept;
}

} // namespace stipple
