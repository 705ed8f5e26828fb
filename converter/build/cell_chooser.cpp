#include "converter/build/cell_chooser.hpp"

#include "shared/codec/checksum.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

namespace stipple {

namespace {
// Products of a position in a node and a number of cells stay within 63 bits.
constexpr double maxCells = 0x1p30;
static_assert(maxNodeBits <= 31);
} // namespace

SampleGrid::SampleGrid(const Spacing& spacing, int nodeBits) : nodeBits_(nodeBits) {
    const Vec3d& weights = spacing.metric.weights;
    double perSide = std::ldexp(1.0, nodeBits) / std::sqrt(spacing.squaredSteps(nodeBits));
    double largest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        count_[axis] = std::llround(std::clamp(perSide * weights[axis], 1.0, maxCells));
        unit_[axis] = weights[axis] / static_cast<double>(count_[axis]);
        largest = std::max(largest, unit_[axis]);
    }
    unit_ = {unit_.x / largest, unit_.y / largest, unit_.z / largest};
}

Vec3i SampleGrid::cellOf(Vec3<std::uint32_t> p) const {
    return {(p.x * count_.x) >> nodeBits_, (p.y * count_.y) >> nodeBits_, (p.z * count_.z) >> nodeBits_};
}

std::uint64_t SampleGrid::indexOf(Vec3i cell) const {
    auto number = [](std::int64_t n) { return static_cast<std::uint64_t>(n); };
    return (number(cell.z) * number(count_.y) + number(cell.y)) * number(count_.x) + number(cell.x);
}

double SampleGrid::squaredToCentre(Vec3<std::uint32_t> p, Vec3i cell) const {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        // The centre is at (cell + 1/2) × side / count: 2 × count times that is an integer.
        std::int64_t offset =
            2 * count_[axis] * static_cast<std::int64_t>(p[axis]) - ((2 * cell[axis] + 1) << nodeBits_);
        double distance = static_cast<double>(offset) * unit_[axis];
        sum += distance * distance;
    }
    return sum;
}

void CellTable::begin(std::size_t mostCells) {
    slots_.assign(std::bit_ceil(2 * mostCells + 1), 0);
    entries_.clear();
}

std::pair<std::uint32_t, bool> CellTable::find(std::uint64_t cell) {
    std::uint64_t mask = slots_.size() - 1;
    std::uint64_t at = cell * 0x9E3779B97F4A7C15ull;
    for (at = (at ^ (at >> 32)) & mask; slots_[at] != 0; at = (at + 1) & mask)
        if (std::uint32_t entry = slots_[at] - 1; entries_[entry].cell == cell)
            return {entry, false};
    entries_.push_back({cell, 0, 0});
    slots_[at] = static_cast<std::uint32_t>(entries_.size());
    return {slots_[at] - 1, true};
}

CellChooser::CellChooser(const Subtree& subtree, const Spacing& spacing, int workers)
    : subtree_(subtree), spacing_(spacing), tables_(static_cast<std::size_t>(workers)) {}

const std::vector<CellTable::Entry>& CellChooser::nearestToCentres(const Candidates& candidates, int worker,
                                                                   std::span<std::uint32_t> entries) {
    SampleGrid grid(spacing_, subtree_.cube().nodeBits(key(candidates).level));
    CellTable& table = tables_[static_cast<std::size_t>(worker)];
    table.begin(candidates.ranks.size());
    for (std::uint32_t i = 0; i < candidates.ranks.size(); ++i) {
        Vec3<std::uint32_t> p = candidates.positions[i];
        Vec3i cell = grid.cellOf(p);
        double squared = grid.squaredToCentre(p, cell);
        auto [index, isNew] = table.find(grid.indexOf(cell));
        entries[i] = index;
        CellTable::Entry& entry = table[index];
        if (isNew || squared < entry.squared) {
            entry.point = i;
            entry.squared = squared;
        }
    }
    return table.entries();
}

void GridChooser::choose(const Candidates& candidates, int worker, std::span<std::uint32_t> representatives) {
    const std::vector<CellTable::Entry>& entries = nearestToCentres(candidates, worker, representatives);
    for (std::uint32_t& representative : representatives)
        representative = entries[representative].point;
}

void RandomChooser::choose(const Candidates& candidates, int worker,
                           std::span<std::uint32_t> representatives) {
    std::size_t count = nearestToCentres(candidates, worker, representatives).size();
    std::fill(representatives.begin(), representatives.end(), nobody);
    if (count == 0)
        return;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(candidates.ranks.size());
    for (std::uint32_t i = 0; i < order.size(); ++i)
        order[i] = {hashOf(candidates.ranks[i], key(candidates).level), i};
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count - 1), order.end());
    for (std::size_t i = 0; i < count; ++i)
        representatives[order[i].second] = order[i].second;
}

// Of the grid integers, then the attributes' bytes; the level decides the seeds of both.
std::uint64_t RandomChooser::hashOf(std::uint32_t rank, int level) const {
    const Vec3i p = subtree_.position(rank);
    std::array<std::uint8_t, sizeof p> position;
    std::memcpy(position.data(), &p, sizeof p);
    const RowLayout& layout = subtree_.layout();
    std::uint64_t ofPosition = xxh64(position, static_cast<std::uint64_t>(level));
    return xxh64(ByteSpan(layout.attributes(subtree_.row(rank)), layout.attributeBytes()), ofPosition);
}

} // namespace stipple
