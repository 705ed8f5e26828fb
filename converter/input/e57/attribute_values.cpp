#include "converter/input/e57/attributes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

namespace stipple::e57 {

namespace {
template <class T>
T fromInteger(std::int64_t value) {
    if constexpr (std::is_floating_point_v<T> || std::is_same_v<T, std::int64_t>)
        return static_cast<T>(value);
    else
        return static_cast<T>(std::clamp(value, static_cast<std::int64_t>(std::numeric_limits<T>::lowest()),
                                         static_cast<std::int64_t>(std::numeric_limits<T>::max())));
}

// Only floating-point attributes and u16 are made of numbers.
template <class T>
T fromNumber(double value) {
    if constexpr (std::is_floating_point_v<T>)
        return static_cast<T>(value);
    else
        return fromInteger<T>(static_cast<std::int64_t>(value));
}

double stretch(double value, const AttributeSource& source) {
    double extent = source.range.max - source.range.min;
    if (!(extent > 0) || std::isnan(value))
        return 0;
    return std::floor(std::clamp((value - source.range.min) / extent, 0.0, 1.0) * source.full + 0.5);
}

template <class T>
void fill(const AttributeSource& source, const ScanEntry& scan, const std::vector<Column>& columns,
          const std::vector<std::uint32_t>& rows, std::uint8_t* out) {
    using How = AttributeSource::How;
    auto put = [&](auto valueOf) {
        for (std::size_t i = 0; i < rows.size(); ++i)
            storeLe<T>(out + i * sizeof(T), valueOf(rows[i]));
    };
    const Field& field = scan.fields[source.field];
    const Column& column = columns[source.field];
    switch (source.how) {
    case How::constant:
        return put([&](std::uint32_t) { return fromInteger<T>(source.add); });
    case How::integer:
        return put([&](std::uint32_t row) {
            // Unsigned: a stream may hold more than its field's maximum.
            auto stored = static_cast<std::uint64_t>(column.integers[row]);
            return fromInteger<T>(
                static_cast<std::int64_t>(static_cast<std::uint64_t>(source.add) +
                                          static_cast<std::uint64_t>(source.multiply) * stored));
        });
    case How::number:
        return put([&](std::uint32_t row) { return fromNumber<T>(source.shift + column.value(field, row)); });
    case How::stretched:
        return put(
            [&](std::uint32_t row) { return fromNumber<T>(stretch(column.value(field, row), source)); });
    }
}

void fillTyped(AttributeType type, const AttributeSource& source, const ScanEntry& scan,
               const std::vector<Column>& columns, const std::vector<std::uint32_t>& rows,
               std::uint8_t* out) {
    switch (type) {
    case AttributeType::u8:
        return fill<std::uint8_t>(source, scan, columns, rows, out);
    case AttributeType::i8:
        return fill<std::int8_t>(source, scan, columns, rows, out);
    case AttributeType::u16:
        return fill<std::uint16_t>(source, scan, columns, rows, out);
    case AttributeType::i16:
        return fill<std::int16_t>(source, scan, columns, rows, out);
    case AttributeType::u32:
        return fill<std::uint32_t>(source, scan, columns, rows, out);
    case AttributeType::i32:
        return fill<std::int32_t>(source, scan, columns, rows, out);
    case AttributeType::i64:
    case AttributeType::u64: // not planned: stored integers fit int64
        return fill<std::int64_t>(source, scan, columns, rows, out);
    case AttributeType::f32:
        return fill<float>(source, scan, columns, rows, out);
    case AttributeType::f64:
        return fill<double>(source, scan, columns, rows, out);
    }
}
} // namespace

void fillAttribute(const Attribute& attribute, const AttributeSource& source, const ScanEntry& scan,
                   const std::vector<Column>& columns, const std::vector<std::uint32_t>& rows, Bytes& out) {
    std::size_t width = attribute.size();
    out.resize(rows.size() * width);
    fillTyped(attribute.type, source, scan, columns, rows, out.data());
    if (source.invalid < 0)
        return;
    const Column& invalid = columns[static_cast<std::size_t>(source.invalid)];
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (invalid.integers[rows[i]] != 0)
            std::fill_n(out.data() + i * width, width, std::uint8_t{0});
}

} // namespace stipple::e57
