#include "shared/sinks/row_text.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stipple {

namespace {

bool isScaled(const Attribute& attribute) {
    return attribute.scale != 1 || attribute.offset != 0;
}

DecimalScale decimalOf(const Attribute& attribute) {
    std::size_t bits = std::min<std::size_t>(8 * attributeTypeSize(attribute.type), 63);
    std::int64_t limit = bits == 63 ? std::numeric_limits<std::int64_t>::max() : std::int64_t{1} << bits;
    return DecimalScale(attribute.scale, attribute.offset, -limit, limit);
}

} // namespace

ValueText::ValueText(const Attribute& attribute) : attribute_(attribute), decimal_(decimalOf(attribute)) {}

void ValueText::append(std::string& text, const std::uint8_t* from) const {
    switch (attribute_.type) {
    case AttributeType::u8:
        return appendWhole<std::uint8_t>(text, from);
    case AttributeType::i8:
        return appendWhole<std::int8_t>(text, from);
    case AttributeType::u16:
        return appendWhole<std::uint16_t>(text, from);
    case AttributeType::i16:
        return appendWhole<std::int16_t>(text, from);
    case AttributeType::u32:
        return appendWhole<std::uint32_t>(text, from);
    case AttributeType::i32:
        return appendWhole<std::int32_t>(text, from);
    case AttributeType::u64:
        return appendWhole<std::uint64_t>(text, from);
    case AttributeType::i64:
        return appendWhole<std::int64_t>(text, from);
    case AttributeType::f32:
        return appendReal<float>(text, from);
    case AttributeType::f64:
        return appendReal<double>(text, from);
    }
}

template <class T>
bool ValueText::meansNothing(T value) const {
    if (!attribute_.noData)
        return false;
    auto number = static_cast<double>(value);
    return number == *attribute_.noData || (std::isnan(number) && std::isnan(*attribute_.noData));
}

template <class T>
void ValueText::appendWhole(std::string& text, const std::uint8_t* from) const {
    T value = loadLe<T>(from);
    if (meansNothing(value))
        return;
    using Wide = std::conditional_t<std::is_signed_v<T>, std::int64_t, std::uint64_t>;
    if (!isScaled(attribute_))
        return appendInteger(text, static_cast<Wide>(value));
    if (std::is_same_v<T, std::uint64_t> && static_cast<std::int64_t>(value) < 0) // beyond the decimals
        return appendShortest(text, attribute_.offset + attribute_.scale * static_cast<double>(value));
    decimal_.append(text, static_cast<std::int64_t>(value));
}

template <class T>
void ValueText::appendReal(std::string& text, const std::uint8_t* from) const {
    T value = loadLe<T>(from);
    if (meansNothing(value))
        return;
    if (isScaled(attribute_))
        return appendShortest(text, attribute_.offset + attribute_.scale * static_cast<double>(value));
    appendShortest(text, value);
}

RowText::RowText(const SinkInput& input) : input_(input) {
    const CloudMetadata& metadata = input.metadata;
    BoxI bounds = metadata.bounds;
    if (bounds.empty())
        bounds.extend(Vec3i{});
    for (int axis = 0; axis < 3; ++axis)
        axes_.emplace_back(metadata.grid.scale[axis], metadata.grid.offset[axis], bounds.min[axis],
                           bounds.max[axis]);
    for (std::size_t i = 0; i < input.attributes.size(); ++i)
        values_.emplace_back(input.attribute(i));
}

std::vector<std::string> RowText::columnNames() const {
    std::vector<std::string> names{"X", "Y", "Z"};
    for (std::size_t i = 0; i < input_.attributes.size(); ++i) {
        const Attribute& attribute = input_.attribute(i);
        for (int c = 0; c < attribute.components; ++c)
            names.push_back(attribute.components == 1 ? attribute.name : cat(attribute.name, "[", c, "]"));
    }
    return names;
}

std::size_t RowText::expectedRowBytes() const {
    constexpr std::size_t bytesPerValue = 10;
    return (3 + values_.size()) * bytesPerValue;
}

} // namespace stipple
