#include "client/core/node_columns.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace stipple {

namespace {

template <class T>
void readValues(ByteSpan column, std::size_t stride, std::vector<double>& values) {
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = static_cast<double>(loadLe<T>(column.data() + i * stride));
}

void readValues(AttributeType type, ByteSpan column, std::size_t stride, std::vector<double>& values) {
    switch (type) {
    case AttributeType::u8:
        return readValues<std::uint8_t>(column, stride, values);
    case AttributeType::i8:
        return readValues<std::int8_t>(column, stride, values);
    case AttributeType::u16:
        return readValues<std::uint16_t>(column, stride, values);
    case AttributeType::i16:
        return readValues<std::int16_t>(column, stride, values);
    case AttributeType::u32:
        return readValues<std::uint32_t>(column, stride, values);
    case AttributeType::i32:
        return readValues<std::int32_t>(column, stride, values);
    case AttributeType::u64:
        return readValues<std::uint64_t>(column, stride, values);
    case AttributeType::i64:
        return readValues<std::int64_t>(column, stride, values);
    case AttributeType::f32:
        return readValues<float>(column, stride, values);
    case AttributeType::f64:
        return readValues<double>(column, stride, values);
    }
}

bool sameName(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](unsigned char x, unsigned char y) { return std::tolower(x) == std::tolower(y); });
}

} // namespace

ByteSpan NodeColumns::column(std::int32_t attribute) const {
    std::size_t from = 0;
    for (const NodeColumn& column : columns) {
        std::size_t size = std::size_t{pointCount} * column.bytesPerPoint;
        if (column.attribute == attribute)
            return ByteSpan(values).subspan(from, size);
        from += size;
    }
    return {};
}

int findAttribute(const Schema& schema, std::string_view name) {
    if (int exact = schema.find(name); exact >= 0)
        return exact;
    for (std::size_t i = 0; i < schema.attributes.size(); ++i)
        if (sameName(schema.attributes[i].name, name))
            return static_cast<int>(i);
    return -1;
}

bool isWhole(const Attribute& attribute) {
    return attribute.type != AttributeType::f32 && attribute.type != AttributeType::f64 &&
           attribute.scale == std::floor(attribute.scale) && attribute.offset == std::floor(attribute.offset);
}

std::vector<double> meaningsOf(const Attribute& attribute, ByteSpan column, std::size_t count) {
    std::vector<double> values(count);
    readValues(attribute.type, column, attribute.size(), values);
    bool scaled = attribute.scale != 1 || attribute.offset != 0;
    for (double& value : values) {
        if (attribute.noData && value == *attribute.noData)
            value = std::numeric_limits<double>::quiet_NaN();
        else if (scaled)
            value = attribute.offset + attribute.scale * value;
    }
    return values;
}

} // namespace stipple
