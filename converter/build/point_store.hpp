// Points in memory, one row each: three 64-bit grid integers, then the attributes' raw bytes in schema
// order. Rows, not columns: points are visited in an order that is not the one they came in, so a point
// should cost one cache miss, not one for each attribute. Equal rows are equal points.
#pragma once

#include "shared/points/point_batch.hpp"

#include <cstring>
#include <memory>
#include <span>

namespace stipple {

class PointStore {
  public:
    PointStore() = default;
    // Room for `count` points, not yet filled. Throws std::bad_alloc.
    PointStore(const Schema& schema, std::uint64_t count);

    std::size_t size() const { return count_; }
    std::size_t rowBytes() const { return rowBytes_; }

    Vec3i position(std::size_t index) const {
        Vec3i p;
        std::memcpy(&p, row(index), sizeof p);
        return p;
    }
    // Position and attributes.
    const std::uint8_t* row(std::size_t index) const { return rows_.get() + index * rowBytes_; }
    const std::uint8_t* attributes(std::size_t index) const { return row(index) + sizeof(Vec3i); }

    // Asks for a row that will be read soon.
    void prefetch(std::size_t index) const { __builtin_prefetch(row(index)); }

    // Fills rows [first, first + batch.size()). Thread: any, for ranges that do not overlap.
    void put(std::size_t first, const PointBatch& batch);
    // The points of these indices as columns.
    void gather(std::span<const std::uint32_t> indices, PointBatch& batch) const;

  private:
    Schema schema_;
    std::vector<std::size_t> offsets_; // of each attribute in a row
    std::size_t count_ = 0, rowBytes_ = sizeof(Vec3i);
    std::unique_ptr<std::uint8_t[]> rows_;
};

} // namespace stipple
