#include "converter/build/point_store.hpp"

#include <algorithm>

namespace stipple {

namespace {
// Copies with the size known to the compiler: a move each, not a call.
template <class IndexOf>
void copyStrided(std::size_t size, std::size_t count, const std::uint8_t* from, std::size_t fromStride,
                 std::uint8_t* to, std::size_t toStride, IndexOf indexOf) {
    auto run = [&](auto copy) {
        for (std::size_t i = 0; i < count; ++i)
            copy(to + i * toStride, from + indexOf(i) * fromStride);
    };
    switch (size) {
    case 1:
        return run([](std::uint8_t* t, const std::uint8_t* f) { *t = *f; });
    case 2:
        return run([](std::uint8_t* t, const std::uint8_t* f) { std::memcpy(t, f, 2); });
    case 4:
        return run([](std::uint8_t* t, const std::uint8_t* f) { std::memcpy(t, f, 4); });
    case 8:
        return run([](std::uint8_t* t, const std::uint8_t* f) { std::memcpy(t, f, 8); });
    default:
        return run([size](std::uint8_t* t, const std::uint8_t* f) { std::memcpy(t, f, size); });
    }
}
} // namespace

PointStore::PointStore(const Schema& schema, std::uint64_t count)
    : schema_(schema), count_(static_cast<std::size_t>(count)) {
    for (const Attribute& attribute : schema.attributes) {
        offsets_.push_back(rowBytes_);
        rowBytes_ += attribute.size();
    }
    rows_ = std::make_unique_for_overwrite<std::uint8_t[]>(count_ * rowBytes_);
}

void PointStore::put(std::size_t first, const PointBatch& batch) {
    std::uint8_t* rows = rows_.get() + first * rowBytes_;
    for (std::size_t i = 0; i < batch.size(); ++i)
        std::memcpy(rows + i * rowBytes_, &batch.positions[i], sizeof(Vec3i));
    for (std::size_t a = 0; a < offsets_.size(); ++a) {
        std::size_t size = schema_.attributes[a].size();
        copyStrided(size, batch.size(), batch.columns[a].data(), size, rows + offsets_[a], rowBytes_,
                    [](std::size_t i) { return i; });
    }
}

void PointStore::gather(std::span<const std::uint32_t> indices, PointBatch& batch) const {
    constexpr std::size_t blockPoints = 512; // rows that stay in the cache from one attribute to the next
    batch.resize(schema_, indices.size());
    for (std::size_t first = 0; first < indices.size(); first += blockPoints) {
        std::span<const std::uint32_t> block =
            indices.subspan(first, std::min(blockPoints, indices.size() - first));
        for (std::uint32_t index : block)
            prefetch(index);
        for (std::size_t i = 0; i < block.size(); ++i)
            batch.positions[first + i] = position(block[i]);
        for (std::size_t a = 0; a < offsets_.size(); ++a) {
            std::size_t size = schema_.attributes[a].size();
            copyStrided(size, block.size(), rows_.get() + offsets_[a], rowBytes_,
                        batch.columns[a].data() + first * size, size,
                        [&](std::size_t i) { return block[i]; });
        }
    }
}

} // namespace stipple
