// Points as rows of bytes: the position, then the attributes' raw bytes in schema order. Rows, not columns:
// points are sorted and dealt out in orders that are not the one they came in, so a point should cost
// one cache miss, not one for each attribute. Equal rows are equal points.
//
// A position is three integers counted from `origin`: 32-bit where all points of a conversion lie
// within 2^31 steps of it, else 64-bit. Behind the attributes rows may have further bytes, whose meaning is
// the caller's.
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/points/point_batch.hpp"

#include <cstring>
#include <span>

namespace stipple {

class RowLayout {
  public:
    RowLayout() = default;
    // For points in `bounds` (may be empty).
    RowLayout(const Schema& schema, const BoxI& bounds);

    const Schema& schema() const { return schema_; }
    std::size_t rowBytes() const { return rowBytes_; }
    std::size_t positionBytes() const { return wide_ ? sizeof(Vec3i) : sizeof(Vec3<std::int32_t>); }
    std::size_t attributeBytes() const { return rowBytes_ - positionBytes() - extraBytes_; }
    std::size_t extraBytes() const { return extraBytes_; }
    // The same rows with so many further bytes.
    RowLayout withExtra(std::size_t bytes) const;
    // Of an attribute in a row.
    std::size_t offset(int attribute) const { return offsets_[static_cast<std::size_t>(attribute)]; }

    // Whether rows can hold the position.
    bool holds(Vec3i p) const {
        return wide_ || (fits(p.x - origin_.x) && fits(p.y - origin_.y) && fits(p.z - origin_.z));
    }
    Vec3i position(const std::uint8_t* row) const {
        if (wide_) {
            Vec3i p;
            std::memcpy(&p, row, sizeof p);
            return p;
        }
        Vec3<std::int32_t> p;
        std::memcpy(&p, row, sizeof p);
        return {origin_.x + p.x, origin_.y + p.y, origin_.z + p.z};
    }
    const std::uint8_t* attributes(const std::uint8_t* row) const { return row + positionBytes(); }
    const std::uint8_t* extra(const std::uint8_t* row) const { return row + rowBytes_ - extraBytes_; }

    // Writes points `indices` of `batch`, all of which the layout holds, as rows one after the other; further
    // bytes are left as they are.
    void pack(const PointBatch& batch, std::span<const std::uint32_t> indices, std::uint8_t* rows) const;
    // The rows of these indices as columns.
    void gather(const std::uint8_t* rows, std::span<const std::uint32_t> indices, PointBatch& batch) const;

  private:
    static bool fits(std::int64_t v) { return v == static_cast<std::int32_t>(v); }

    Schema schema_;
    std::vector<std::size_t> offsets_; // of each attribute in a row
    Vec3i origin_;
    bool wide_ = false;
    std::size_t rowBytes_ = sizeof(Vec3<std::int32_t>), extraBytes_ = 0;
};

} // namespace stipple
