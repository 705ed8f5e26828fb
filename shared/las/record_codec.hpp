// Point records ↔ columns. One loop per attribute over a block of records that stays in the first-level
// cache: about a nanosecond per attribute and point.
#pragma once

#include "shared/base/result.hpp"
#include "shared/las/record_layout.hpp"
#include "shared/points/point_batch.hpp"

namespace stipple::las {

// Unpacks whole records (records.size() is a multiple of layout.recordLength) into batch[first, …), which
// is sized already.
void unpackRecords(const RecordLayout& layout, ByteSpan records, PointBatch& batch, std::size_t first);

// Which field of a record a column of a batch fills; columns without a field are left out.
struct ColumnField {
    std::size_t column = 0;
    RecordField field;
};

// Packs points [first, first + count) of `batch` into `records` (count × recordLength bytes, overwritten).
// outOfRange: an integer beyond 32 bits or a value too wide for its bit field; says which point.
Status packRecords(const RecordLayout& layout, const std::vector<ColumnField>& columns, const Schema& schema,
                   const PointBatch& batch, std::size_t first, std::size_t count, std::uint8_t* records);

} // namespace stipple::las
