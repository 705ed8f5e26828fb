// Rows of a file of records of one size: a field of row i stands at begin + i × recordBytes + its offset.
#pragma once

#include "converter/input/file_cursor.hpp"
#include "converter/input/table.hpp"

namespace stipple {

struct RecordLayout {
    std::uint64_t begin = 0; // byte of the first record
    std::uint64_t count = 0; // of records; the file is known to hold them
    std::size_t recordBytes = 0;
    std::vector<std::size_t> offsets; // parallel to the table's fields, which are not text
    bool bigEndian = false;
};

// Copies `count` values of `width` bytes, every `stride` bytes, together; turns them round where `swap`.
void gatherColumn(const std::uint8_t* from, std::size_t stride, std::size_t count, std::size_t width,
                  std::size_t components, bool swap, std::uint8_t* to);

// Borrows everything. `place.row` says where to begin.
std::unique_ptr<RowReader> readRecords(SharedSource& source, const RecordLayout& layout,
                                       const std::vector<TableField>& fields, const RowPlace& place);

} // namespace stipple
