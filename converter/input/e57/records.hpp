// The records of a span as columns of numbers, as the fields state them.
#pragma once

#include "converter/input/e57/packets.hpp"

namespace stipple::e57 {

// The values of one field: `integers` (as stored) of integer fields, `floats` of the others.
struct Column {
    std::vector<std::int64_t> integers;
    std::vector<double> floats;

    // Value `i` as a number of the field's unit.
    double value(const Field& field, std::size_t i) const {
        return field.isFloat() ? floats[i] : field.offset + field.scale * static_cast<double>(integers[i]);
    }
};

// Runs of records of one span, one after the other. Thread: one. Memory: the columns, and one field's bytes.
class RecordReader {
  public:
    // `fields`: those wanted, ascending. All that is referred to must outlive it.
    RecordReader(PagedFile& file, const ScanEntry& scan, const Section& section, const RecordSpan& span,
                 const std::vector<std::size_t>& fields);

    // How many records are a good run for so many fields: few enough that what is read of the file for one
    // field is still at hand for the next.
    static std::size_t goodRun(const ScanEntry& scan, std::size_t wantedFields);

    std::uint64_t remaining() const { return end_ - at_; }
    // The next `count` records, at most those remaining; columns[f] for each wanted field f.
    Status next(std::size_t count, std::vector<Column>& columns);

  private:
    Status readField(std::size_t cursor, std::size_t count, Column& column);

    const ScanEntry& scan_;
    const std::vector<std::size_t>& fields_;
    std::vector<StreamCursor> cursors_; // of each wanted field
    std::uint64_t at_, end_;            // records since the streams' (re)start
    Bytes bytes_;
};

// Blocks for a RecordReader: what a good run takes, and as much for streams that run ahead of others.
inline constexpr std::size_t recordPagesPerBlock = 128, recordBlocks = 24;

} // namespace stipple::e57
