#include "shared/las/extra_bytes.hpp"

#include "shared/base/text.hpp"
#include "shared/las/header_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace stipple::las {

namespace {

enum Option : std::uint8_t { hasNoData = 1, hasMin = 2, hasMax = 4, hasScale = 8, hasOffset = 16 };
constexpr std::size_t nameWidth = 32, descriptionWidth = 32;

enum class Kind { isUnsigned, isSigned, isFloat };
Kind kindOf(AttributeType type) {
    if (type == AttributeType::f32 || type == AttributeType::f64)
        return Kind::isFloat;
    return static_cast<int>(type) % 2 == 0 ? Kind::isUnsigned : Kind::isSigned;
}

// A descriptor's "anytype" field as a double, and back (saturated: 2^64 becomes the largest u64).
double anyToDouble(Kind kind, std::uint64_t bits) {
    if (kind == Kind::isFloat)
        return bitCast<double>(bits);
    return kind == Kind::isSigned ? static_cast<double>(static_cast<std::int64_t>(bits))
                                  : static_cast<double>(bits);
}
std::uint64_t doubleToAny(Kind kind, double value) {
    if (kind == Kind::isFloat)
        return bitCast<std::uint64_t>(value);
    if (std::isnan(value))
        return 0;
    if (kind == Kind::isSigned) {
        if (value >= 0x1p63)
            return static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
        return value <= -0x1p63 ? 1ull << 63 : static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
    }
    if (value >= 0x1p64)
        return std::numeric_limits<std::uint64_t>::max();
    return value <= 0 ? 0 : static_cast<std::uint64_t>(value);
}

struct Descriptor {
    std::uint8_t dataType = 0, options = 0;
    std::string name, description;
    std::array<std::uint64_t, 3> noData{};
    std::array<double, 3> scale{}, offset{};

    int components() const { return dataType == 0 ? options : dataType <= 10 ? 1 : dataType <= 20 ? 2 : 3; }
    AttributeType type() const {
        return dataType == 0 ? AttributeType::u8 : static_cast<AttributeType>((dataType - 1) % 10);
    }
    // `options` of undescribed bytes is their number, not a set of flags.
    bool has(Option option) const { return dataType != 0 && (options & option) != 0; }
    bool componentsAgree() const {
        for (int c = 1; dataType > 10 && c < components(); ++c) {
            auto i = static_cast<std::size_t>(c);
            if ((has(hasNoData) && noData[i] != noData[0]) || (has(hasScale) && scale[i] != scale[0]) ||
                (has(hasOffset) && offset[i] != offset[0]))
                return false;
        }
        return true;
    }
};

Descriptor parseDescriptor(ByteSpan bytes) {
    Descriptor descriptor;
    ByteReader reader(bytes);
    reader.skip(2);
    descriptor.dataType = reader.read<std::uint8_t>();
    descriptor.options = reader.read<std::uint8_t>();
    descriptor.name = readableText(reader.readFixedText(nameWidth));
    reader.skip(4);
    for (std::uint64_t& value : descriptor.noData)
        value = reader.read<std::uint64_t>();
    reader.skip(48); // min and max: the points themselves say
    for (double& value : descriptor.scale)
        value = reader.read<double>();
    for (double& value : descriptor.offset)
        value = reader.read<double>();
    descriptor.description = readableText(reader.readFixedText(descriptionWidth));
    return descriptor;
}

// Adds attributes one after the other, from the end of the base format on.
class Appender {
  public:
    Appender(RecordLayout& layout, std::vector<std::string>& warnings)
        : layout_(layout), warnings_(warnings), at_(layout.recordLength) {
        for (const Attribute& attribute : layout.schema.attributes)
            taken_.insert(attribute.name);
    }

    std::size_t position() const { return at_; }

    void add(Attribute attribute) {
        attribute.name = uniqueName(attribute.name);
        layout_.fields.push_back({layout_.schema.attributes.size(), at_, attribute.size(), 0, 0});
        at_ += attribute.size();
        layout_.schema.attributes.push_back(std::move(attribute));
    }

    void addDescribed(const Descriptor& descriptor) {
        Attribute attribute;
        attribute.name = descriptor.name;
        attribute.type = descriptor.type();
        attribute.description = descriptor.description;
        if (descriptor.componentsAgree()) {
            attribute.components = descriptor.components();
            return add(scaled(std::move(attribute), descriptor, 0));
        }
        // An attribute has one scale: components that differ become attributes of their own.
        for (int c = 0; c < descriptor.components(); ++c) {
            Attribute part = scaled(attribute, descriptor, static_cast<std::size_t>(c));
            part.name = cat(descriptor.name, "[", c, "]");
            add(std::move(part));
        }
    }

  private:
    Attribute scaled(Attribute attribute, const Descriptor& descriptor, std::size_t component) {
        if (descriptor.has(hasNoData))
            attribute.noData = anyToDouble(kindOf(attribute.type), descriptor.noData[component]);
        double scale = descriptor.has(hasScale) ? descriptor.scale[component] : 1;
        double offset = descriptor.has(hasOffset) ? descriptor.offset[component] : 0;
        if (!std::isfinite(scale) || scale == 0 || !std::isfinite(offset)) {
            warnings_.push_back(cat("the extra bytes \"", descriptor.name, "\" have the scale ", scale,
                                    " and offset ", offset, "; their stored values are taken as they are"));
            return attribute;
        }
        attribute.scale = scale;
        attribute.offset = offset;
        return attribute;
    }

    std::string uniqueName(const std::string& wanted) {
        std::string name = wanted.empty() ? "Unnamed" : wanted;
        if (taken_.insert(name).second)
            return name;
        // The count goes on from the last such name: thousands of equal names stay linear.
        for (int& number = lastNumber_.try_emplace(name, 1).first->second;;)
            if (auto [place, isNew] = taken_.insert(cat(name, " ", ++number)); isNew)
                return *place;
    }

    RecordLayout& layout_;
    std::vector<std::string>& warnings_;
    std::size_t at_;
    std::unordered_set<std::string> taken_;
    std::unordered_map<std::string, int> lastNumber_;
};

void extendLimits(ValueRange::Limits& limits, Kind kind, std::uint64_t bits) {
    auto less = [kind](std::uint64_t a, std::uint64_t b) {
        if (kind == Kind::isFloat)
            return bitCast<double>(a) < bitCast<double>(b);
        return kind == Kind::isSigned ? static_cast<std::int64_t>(a) < static_cast<std::int64_t>(b) : a < b;
    };
    if (!limits.known || less(bits, limits.minBits))
        limits.minBits = bits;
    if (!limits.known || less(limits.maxBits, bits))
        limits.maxBits = bits;
    limits.known = true;
}

template <class T>
void extendRangeAs(ValueRange& range, const Attribute& attribute, ByteSpan column) {
    Kind kind = kindOf(attribute.type);
    std::size_t components = static_cast<std::size_t>(attribute.components);
    std::size_t count = column.size() / sizeof(T);
    for (std::size_t c = 0; c < std::min<std::size_t>(components, 3); ++c) {
        // Over the block in its own type first; the wide form of a value is made twice a block.
        bool any = false;
        T low{}, high{};
        for (std::size_t i = c; i < count; i += components) {
            T value = loadLe<T>(column.data() + i * sizeof(T));
            if (attribute.noData && static_cast<double>(value) == *attribute.noData)
                continue;
            if constexpr (std::is_floating_point_v<T>)
                if (std::isnan(value))
                    continue;
            low = any ? std::min(low, value) : value;
            high = any ? std::max(high, value) : value;
            any = true;
        }
        for (T value : {low, high}) {
            if (!any)
                continue;
            if constexpr (std::is_floating_point_v<T>)
                extendLimits(range.component[c], kind, bitCast<std::uint64_t>(double{value}));
            else if constexpr (std::is_signed_v<T>)
                extendLimits(range.component[c], kind,
                             static_cast<std::uint64_t>(static_cast<std::int64_t>(value)));
            else
                extendLimits(range.component[c], kind, value);
        }
    }
}

} // namespace

void addExtraBytes(RecordLayout& layout, std::size_t recordLength, ByteSpan descriptors,
                   std::vector<std::string>& warnings) {
    Appender appender(layout, warnings);
    if (descriptors.size() % extraBytesDescriptorSize != 0)
        warnings.push_back(cat("the extra bytes record has ", descriptors.size(),
                               " bytes, not a multiple of 192; its end is ignored"));
    for (std::size_t i = 0; i < descriptors.size() / extraBytesDescriptorSize; ++i) {
        Descriptor descriptor =
            parseDescriptor(descriptors.subspan(i * extraBytesDescriptorSize, extraBytesDescriptorSize));
        if (descriptor.dataType > 30) {
            warnings.push_back(cat("extra bytes \"", descriptor.name, "\" have the unknown type ",
                                   descriptor.dataType, "; they and what follows are kept as bytes"));
            break;
        }
        std::size_t size =
            attributeTypeSize(descriptor.type()) * static_cast<std::size_t>(descriptor.components());
        if (size > recordLength - appender.position()) {
            warnings.push_back(cat("extra bytes \"", descriptor.name, "\" need ", size,
                                   " bytes, but the point record has only ",
                                   recordLength - appender.position(), " left; they are ignored"));
            break;
        }
        if (size > 0)
            appender.addDescribed(descriptor);
    }
    while (appender.position() < recordLength) {
        Attribute rest;
        rest.name = attribute_names::extraBytes;
        rest.components = static_cast<int>(std::min<std::size_t>(255, recordLength - appender.position()));
        appender.add(std::move(rest));
    }
    layout.recordLength = recordLength;
}

void extendRange(ValueRange& range, const Attribute& attribute, ByteSpan column) {
    switch (attribute.type) {
    case AttributeType::u8:
        return extendRangeAs<std::uint8_t>(range, attribute, column);
    case AttributeType::i8:
        return extendRangeAs<std::int8_t>(range, attribute, column);
    case AttributeType::u16:
        return extendRangeAs<std::uint16_t>(range, attribute, column);
    case AttributeType::i16:
        return extendRangeAs<std::int16_t>(range, attribute, column);
    case AttributeType::u32:
        return extendRangeAs<std::uint32_t>(range, attribute, column);
    case AttributeType::i32:
        return extendRangeAs<std::int32_t>(range, attribute, column);
    case AttributeType::u64:
        return extendRangeAs<std::uint64_t>(range, attribute, column);
    case AttributeType::i64:
        return extendRangeAs<std::int64_t>(range, attribute, column);
    case AttributeType::f32:
        return extendRangeAs<float>(range, attribute, column);
    case AttributeType::f64:
        return extendRangeAs<double>(range, attribute, column);
    }
}

Result<Bytes> encodeDescriptor(const Attribute& attribute, const ValueRange& range) {
    bool plainBytes = attribute.type == AttributeType::u8 && attribute.components != 1;
    bool tuple = attribute.components >= 1 && attribute.components <= 3;
    if (!tuple && !(plainBytes && attribute.components >= 1 && attribute.components <= 255))
        return Error{ErrorCode::invalidArgument,
                     cat("LAS has no extra bytes for ", attribute.components, " values of ",
                         attributeTypeName(attribute.type)),
                     cat("attribute \"", attribute.name, "\""), "split it into attributes of one value"};
    Kind kind = kindOf(attribute.type);
    std::uint8_t options = 0;
    std::uint8_t dataType = 0;
    if (tuple) {
        dataType =
            static_cast<std::uint8_t>(static_cast<int>(attribute.type) + 1 + 10 * (attribute.components - 1));
        options = static_cast<std::uint8_t>(
            (attribute.noData ? hasNoData : 0) | (attribute.scale != 1 ? hasScale : 0) |
            (attribute.offset != 0 ? hasOffset : 0) | (range.component[0].known ? hasMin | hasMax : 0));
    } else {
        options = static_cast<std::uint8_t>(attribute.components);
    }
    auto used = [&](std::size_t c) { return tuple && c < static_cast<std::size_t>(attribute.components); };

    ByteWriter writer;
    writer.write(std::uint16_t{0});
    writer.write(dataType);
    writer.write(options);
    writer.writeFixedText(descriptorName(attribute.name), nameWidth);
    writer.write(std::uint32_t{0});
    for (std::size_t c = 0; c < 3; ++c)
        writer.write(used(c) && attribute.noData ? doubleToAny(kind, *attribute.noData) : std::uint64_t{0});
    for (std::size_t c = 0; c < 3; ++c)
        writer.write(used(c) ? range.component[c].minBits : std::uint64_t{0});
    for (std::size_t c = 0; c < 3; ++c)
        writer.write(used(c) ? range.component[c].maxBits : std::uint64_t{0});
    for (std::size_t c = 0; c < 3; ++c)
        writer.write(used(c) && attribute.scale != 1 ? attribute.scale : 0.0);
    for (std::size_t c = 0; c < 3; ++c)
        writer.write(used(c) && attribute.offset != 0 ? attribute.offset : 0.0);
    writer.writeFixedText(attribute.description, descriptionWidth);
    return writer.take();
}

std::string descriptorName(const std::string& name) {
    std::size_t length = std::min(name.size(), nameWidth);
    // A continuation byte of UTF-8 (10xxxxxx) right after the cut: the character began before it.
    while (length > 0 && length < name.size() && (static_cast<std::uint8_t>(name[length]) & 0xC0) == 0x80)
        --length;
    return name.substr(0, length);
}

bool isUndescribed(const Attribute& attribute) {
    if (attribute.type != AttributeType::u8 || !attribute.description.empty() || attribute.scale != 1 ||
        attribute.offset != 0 || attribute.noData)
        return false;
    std::string_view name = attribute.name;
    if (!name.starts_with(attribute_names::extraBytes))
        return false;
    name.remove_prefix(attribute_names::extraBytes.size());
    return name.empty() || (name[0] == ' ' && name.size() > 1 &&
                            name.find_first_not_of("0123456789", 1) == std::string_view::npos);
}

} // namespace stipple::las
