#include "converter/build/row_layout.hpp"

#include <algorithm>

namespace stipple {

namespace {
constexpr std::size_t blockPoints = 512; // rows that stay in the cache from one attribute to the next

// Copies with the size known to the compiler: a move each, not a call.
template <class Copy>
void forWidth(std::size_t size, Copy copyAll) {
    switch (size) {
    case 1:
        return copyAll([](std::uint8_t* to, const std::uint8_t* from) { *to = *from; });
    case 2:
        return copyAll([](std::uint8_t* to, const std::uint8_t* from) { std::memcpy(to, from, 2); });
    case 4:
        return copyAll([](std::uint8_t* to, const std::uint8_t* from) { std::memcpy(to, from, 4); });
    case 8:
        return copyAll([](std::uint8_t* to, const std::uint8_t* from) { std::memcpy(to, from, 8); });
    default:
        return copyAll([size](std::uint8_t* to, const std::uint8_t* from) { std::memcpy(to, from, size); });
    }
}

// The middle of an axis, whose distance to both ends may not fit a signed number.
std::int64_t middle(std::int64_t low, std::int64_t high) {
    return low / 2 + high / 2;
}
} // namespace

RowLayout::RowLayout(const Schema& schema, const BoxI& bounds) : schema_(schema) {
    constexpr std::int64_t widest = std::int64_t{1} << 62; // no difference of such integers overflows
    for (int axis = 0; axis < 3 && !bounds.empty(); ++axis) {
        std::int64_t low = bounds.min[axis], high = bounds.max[axis];
        bool small = low == static_cast<std::int32_t>(low) && high == static_cast<std::int32_t>(high);
        origin_[axis] = small || low < -widest || high > widest ? 0 : middle(low, high);
        wide_ = wide_ || !fits(low - origin_[axis]) || !fits(high - origin_[axis]);
    }
    if (wide_)
        origin_ = {};
    rowBytes_ = positionBytes();
    for (const Attribute& attribute : schema.attributes) {
        offsets_.push_back(rowBytes_);
        rowBytes_ += attribute.size();
    }
}

RowLayout RowLayout::withExtra(std::size_t bytes) const {
    RowLayout other = *this;
    other.rowBytes_ += bytes;
    other.extraBytes_ += bytes;
    return other;
}

void RowLayout::pack(const PointBatch& batch, std::span<const std::uint32_t> indices,
                     std::uint8_t* rows) const {
    for (std::size_t first = 0; first < indices.size(); first += blockPoints) {
        std::span<const std::uint32_t> block =
            indices.subspan(first, std::min(blockPoints, indices.size() - first));
        std::uint8_t* to = rows + first * rowBytes_;
        for (std::size_t i = 0; i < block.size(); ++i) {
            Vec3i p = batch.positions[block[i]];
            if (wide_) {
                std::memcpy(to + i * rowBytes_, &p, sizeof p);
                continue;
            }
            Vec3<std::int32_t> small{static_cast<std::int32_t>(p.x - origin_.x),
                                     static_cast<std::int32_t>(p.y - origin_.y),
                                     static_cast<std::int32_t>(p.z - origin_.z)};
            std::memcpy(to + i * rowBytes_, &small, sizeof small);
        }
        for (std::size_t a = 0; a < offsets_.size(); ++a) {
            std::size_t size = schema_.attributes[a].size();
            const std::uint8_t* column = batch.columns[a].data();
            forWidth(size, [&](auto copy) {
                for (std::size_t i = 0; i < block.size(); ++i)
                    copy(to + i * rowBytes_ + offsets_[a], column + block[i] * size);
            });
        }
    }
}

void RowLayout::gather(const std::uint8_t* rows, std::span<const std::uint32_t> indices,
                       PointBatch& batch) const {
    batch.resize(schema_, indices.size());
    for (std::size_t first = 0; first < indices.size(); first += blockPoints) {
        std::span<const std::uint32_t> block =
            indices.subspan(first, std::min(blockPoints, indices.size() - first));
        for (std::uint32_t index : block)
            __builtin_prefetch(rows + index * rowBytes_);
        for (std::size_t i = 0; i < block.size(); ++i)
            batch.positions[first + i] = position(rows + block[i] * rowBytes_);
        for (std::size_t a = 0; a < offsets_.size(); ++a) {
            std::size_t size = schema_.attributes[a].size();
            std::uint8_t* column = batch.columns[a].data() + first * size;
            forWidth(size, [&](auto copy) {
                for (std::size_t i = 0; i < block.size(); ++i)
                    copy(column + i * size, rows + block[i] * rowBytes_ + offsets_[a]);
            });
        }
    }
}

} // namespace stipple
