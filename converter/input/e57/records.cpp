#include "converter/input/e57/records.hpp"

#include "converter/input/e57/bitpack.hpp"

#include <algorithm>

namespace stipple::e57 {

namespace {
constexpr std::uint64_t runFileBytes = std::uint64_t{3} << 19, runValues = std::uint64_t{1} << 21;
constexpr std::uint64_t mostRecords = 16384, fewestRecords = 256;
static_assert(runFileBytes + 2 * recordPagesPerBlock * pagePayloadBytes <
              recordBlocks * recordPagesPerBlock * pagePayloadBytes);

template <class T>
void toDoubles(const std::uint8_t* from, std::vector<double>& out) {
    for (std::size_t i = 0; i < out.size(); ++i)
        out[i] = static_cast<double>(loadLe<T>(from + i * sizeof(T)));
}
} // namespace

RecordReader::RecordReader(PagedFile& file, const ScanEntry& scan, const Section& section,
                           const RecordSpan& span, const std::vector<std::size_t>& fields)
    : scan_(scan), fields_(fields), at_(span.skipped), end_(span.skipped + span.count) {
    for (std::size_t field : fields)
        cursors_.emplace_back(file, section, span, field, scan.fields.size());
}

std::size_t RecordReader::goodRun(const ScanEntry& scan, std::size_t wantedFields) {
    std::uint64_t bits = 1;
    for (const Field& field : scan.fields)
        bits += static_cast<std::uint64_t>(field.bits);
    std::uint64_t records = std::min(
        {8 * runFileBytes / bits, runValues / std::max<std::uint64_t>(wantedFields, 1), mostRecords});
    return static_cast<std::size_t>(std::max(records, fewestRecords));
}

Status RecordReader::next(std::size_t count, std::vector<Column>& columns) {
    count = static_cast<std::size_t>(std::min<std::uint64_t>(count, remaining()));
    columns.resize(scan_.fields.size());
    for (std::size_t c = 0; c < cursors_.size(); ++c)
        STIPPLE_CHECK(readField(c, count, columns[fields_[c]]));
    at_ += count;
    return {};
}

Status RecordReader::readField(std::size_t cursor, std::size_t count, Column& column) {
    const Field& field = scan_.fields[fields_[cursor]];
    auto bits = static_cast<std::uint64_t>(field.bits);
    std::uint64_t beginBit = at_ * bits, endBit = (at_ + count) * bits;
    std::size_t size = static_cast<std::size_t>((endBit + 7) / 8 - beginBit / 8);
    bytes_.resize(size + unpackPadding);
    STIPPLE_CHECK(cursors_[cursor].read(beginBit / 8, std::span(bytes_).first(size)));
    if (field.isFloat()) {
        column.floats.resize(count);
        field.kind == FieldKind::float32 ? toDoubles<float>(bytes_.data(), column.floats)
                                         : toDoubles<double>(bytes_.data(), column.floats);
    } else {
        column.integers.resize(count);
        unpackIntegers(bytes_.data(), static_cast<int>(beginBit % 8), field.bits, field.minimum,
                       column.integers);
    }
    return {};
}

} // namespace stipple::e57
