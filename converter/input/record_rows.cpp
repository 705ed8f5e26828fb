#include "converter/input/record_rows.hpp"

#include <algorithm>

namespace stipple {

namespace {
template <class Word>
Word turned(Word word) {
    if constexpr (sizeof(Word) == 2)
        return __builtin_bswap16(word);
    else if constexpr (sizeof(Word) == 4)
        return __builtin_bswap32(word);
    else if constexpr (sizeof(Word) == 8)
        return __builtin_bswap64(word);
    else
        return word;
}

template <class Word>
void gather(const std::uint8_t* from, std::size_t stride, std::size_t count, std::size_t components,
            bool swap, std::uint8_t* to) {
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t c = 0; c < components; ++c) {
            Word word = loadLe<Word>(from + i * stride + c * sizeof(Word));
            storeLe(to + (i * components + c) * sizeof(Word), swap ? turned(word) : word);
        }
}

class RecordReader final : public RowReader {
  public:
    RecordReader(SharedSource& source, const RecordLayout& layout, const std::vector<TableField>& fields,
                 const RowPlace& place)
        : layout_(layout), fields_(fields), row_(place.row),
          cursor_(source, layout.begin + place.row * layout.recordBytes), name_(source.name()) {}

    Status next(Rows& rows, std::size_t most) override {
        std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(most, layout_.count - row_));
        rows.resize(fields_, count);
        if (count == 0)
            return {};
        STIPPLE_TRY(bytes, cursor_.peek(count * layout_.recordBytes));
        if (bytes.size() < count * layout_.recordBytes)
            return Error{ErrorCode::changed, "the file became shorter while it was read", name_, ""};
        for (std::size_t f = 0; f < fields_.size(); ++f)
            gatherColumn(bytes.data() + layout_.offsets[f], layout_.recordBytes, count,
                         attributeTypeSize(*fields_[f].type), static_cast<std::size_t>(fields_[f].components),
                         layout_.bigEndian, rows.columns[f].data());
        cursor_.skip(count * layout_.recordBytes);
        row_ += count;
        return {};
    }
    RowPlace place() const override {
        RowPlace place;
        place.row = row_;
        return place;
    }

  private:
    const RecordLayout& layout_;
    const std::vector<TableField>& fields_;
    std::uint64_t row_;
    FileCursor cursor_;
    std::string name_;
};
} // namespace

void gatherColumn(const std::uint8_t* from, std::size_t stride, std::size_t count, std::size_t width,
                  std::size_t components, bool swap, std::uint8_t* to) {
    switch (width) {
    case 1:
        return gather<std::uint8_t>(from, stride, count, components, false, to);
    case 2:
        return gather<std::uint16_t>(from, stride, count, components, swap, to);
    case 4:
        return gather<std::uint32_t>(from, stride, count, components, swap, to);
    default:
        return gather<std::uint64_t>(from, stride, count, components, swap, to);
    }
}

std::unique_ptr<RowReader> readRecords(SharedSource& source, const RecordLayout& layout,
                                       const std::vector<TableField>& fields, const RowPlace& place) {
    return std::make_unique<RecordReader>(source, layout, fields, place);
}

} // namespace stipple
