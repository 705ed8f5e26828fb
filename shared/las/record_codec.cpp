#include "shared/las/record_codec.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <limits>

namespace stipple::las {

namespace {

// 256 records of format 3 are 8.5 kB: they and the columns they go to fit the first-level cache.
constexpr std::size_t blockRecords = 256;

template <std::size_t Size>
void copyStrided(const std::uint8_t* from, std::size_t fromStride, std::uint8_t* to, std::size_t toStride,
                 std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(to + i * toStride, from + i * fromStride, Size);
}

// `size` bytes from each `fromStride`-th place to each `toStride`-th.
void copyStrided(const std::uint8_t* from, std::size_t fromStride, std::uint8_t* to, std::size_t toStride,
                 std::size_t size, std::size_t count) {
    switch (size) {
    case 1:
        return copyStrided<1>(from, fromStride, to, toStride, count);
    case 2:
        return copyStrided<2>(from, fromStride, to, toStride, count);
    case 4:
        return copyStrided<4>(from, fromStride, to, toStride, count);
    case 8:
        return copyStrided<8>(from, fromStride, to, toStride, count);
    default:
        for (std::size_t i = 0; i < count; ++i)
            std::memcpy(to + i * toStride, from + i * fromStride, size);
    }
}

void unpackPositions(const std::uint8_t* records, std::size_t stride, Vec3i* to, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* record = records + i * stride;
        to[i] = {loadLe<std::int32_t>(record), loadLe<std::int32_t>(record + 4),
                 loadLe<std::int32_t>(record + 8)};
    }
}

void unpackField(const RecordField& field, const std::uint8_t* records, std::size_t stride, std::uint8_t* to,
                 std::size_t count) {
    const std::uint8_t* from = records + field.offsetBytes;
    if (field.bits == 0)
        return copyStrided(from, stride, to, field.sizeBytes, field.sizeBytes, count);
    unsigned mask = (1u << field.bits) - 1;
    for (std::size_t i = 0; i < count; ++i)
        to[i] = static_cast<std::uint8_t>((from[i * stride] >> field.shift) & mask);
}

// True if all positions fit; a branch-free test of the whole block.
bool packPositions(const Vec3i* from, std::uint8_t* records, std::size_t stride, std::size_t count) {
    std::uint64_t beyond = 0;
    for (std::size_t i = 0; i < count; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            auto value = static_cast<std::int32_t>(from[i][axis]);
            beyond |= static_cast<std::uint64_t>(from[i][axis] ^ value);
            storeLe(records + i * stride + 4 * axis, value);
        }
    return beyond == 0;
}

bool packField(const RecordField& field, const std::uint8_t* from, std::uint8_t* records, std::size_t stride,
               std::size_t count) {
    std::uint8_t* to = records + field.offsetBytes;
    if (field.bits == 0) {
        copyStrided(from, field.sizeBytes, to, stride, field.sizeBytes, count);
        return true;
    }
    unsigned beyond = 0;
    for (std::size_t i = 0; i < count; ++i) {
        beyond |= static_cast<unsigned>(from[i]) >> field.bits;
        to[i * stride] = static_cast<std::uint8_t>(to[i * stride] | (from[i] << field.shift));
    }
    return beyond == 0;
}

Error positionError(const PointBatch& batch, std::size_t first, std::size_t count) {
    constexpr std::int64_t low = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t high = std::numeric_limits<std::int32_t>::max();
    std::size_t at = first;
    int axis = 0;
    for (std::size_t i = first; i < first + count; ++i)
        for (int a = 0; a < 3; ++a)
            if (batch.positions[i][a] < low || batch.positions[i][a] > high) {
                at = i;
                axis = a;
            }
    return {
        ErrorCode::outOfRange,
        cat("LAS stores ", "XYZ"[axis], " in 32 bits, but it is ", batch.positions[at][axis], " grid steps"),
        cat("point ", at, " of the batch"), "choose an offset near the points, or a coarser scale"};
}

Error fieldError(const RecordLayout& layout, const ColumnField& column, const Attribute& attribute,
                 const PointBatch& batch, std::size_t first, std::size_t count) {
    const Bytes& values = batch.columns[column.column];
    std::size_t at = first;
    while (at + 1 < first + count && (values[at] >> column.field.bits) == 0)
        ++at;
    return {ErrorCode::outOfRange,
            cat(attribute.name, " ", values[at], " does not fit the ", column.field.bits,
                column.field.bits == 1 ? " bit" : " bits", " it has in point format ", layout.pointFormat),
            cat("point ", at, " of the batch"), "write a point format from 6 on"};
}

} // namespace

void unpackRecords(const RecordLayout& layout, ByteSpan records, PointBatch& batch, std::size_t first) {
    std::size_t stride = layout.recordLength;
    std::size_t total = records.size() / stride;
    for (std::size_t done = 0; done < total; done += blockRecords) {
        std::size_t count = std::min(blockRecords, total - done);
        const std::uint8_t* block = records.data() + done * stride;
        unpackPositions(block, stride, batch.positions.data() + first + done, count);
        for (const RecordField& field : layout.fields)
            unpackField(field, block, stride,
                        batch.columns[field.attribute].data() + (first + done) * field.sizeBytes, count);
    }
}

Status packRecords(const RecordLayout& layout, const std::vector<ColumnField>& columns, const Schema& schema,
                   const PointBatch& batch, std::size_t first, std::size_t count, std::uint8_t* records) {
    std::size_t stride = layout.recordLength;
    std::fill_n(records, count * stride, std::uint8_t{0});
    for (std::size_t done = 0; done < count; done += blockRecords) {
        std::size_t part = std::min(blockRecords, count - done);
        std::size_t from = first + done;
        std::uint8_t* block = records + done * stride;
        if (!packPositions(batch.positions.data() + from, block, stride, part))
            return positionError(batch, from, part);
        for (const ColumnField& column : columns) {
            const std::uint8_t* values = batch.columns[column.column].data() + from * column.field.sizeBytes;
            if (!packField(column.field, values, block, stride, part))
                return fieldError(layout, column, schema.attributes[column.column], batch, from, part);
        }
    }
    return {};
}

} // namespace stipple::las
