#include "converter/export/ply_properties.hpp"

#include "shared/base/text.hpp"
#include "shared/las/las_reader.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace stipple {

namespace {

using Form = WrittenPlyProperty::Form;

constexpr double exactInDouble = 0x1p53;

bool isLasName(const std::string& name) {
    return las::schemaOf(5).find(name) >= 0 || las::schemaOf(10).find(name) >= 0;
}

// A name is one word in the header.
std::string propertyName(const Attribute& attribute) {
    bool las = isLasName(attribute.name);
    std::string name;
    for (char c : attribute.name) {
        auto byte = static_cast<unsigned char>(c);
        if (byte <= ' ' || byte == 0x7F || (las && c == '-'))
            name += '_';
        else if (las && c >= 'A' && c <= 'Z')
            name += static_cast<char>(c - 'A' + 'a');
        else
            name += c;
    }
    return name.empty() ? "unnamed" : name;
}

const char* plyType(AttributeType type) {
    constexpr std::array<const char*, 10> names{"uchar", "char", "ushort", "short", "uint",
                                                "int",   "",     "",       "float", "double"};
    return names[static_cast<std::size_t>(type)];
}

bool isColour(const std::string& name) {
    return name == attribute_names::red || name == attribute_names::green || name == attribute_names::blue;
}

class LayoutMaker {
  public:
    explicit LayoutMaker(const SinkInput& input) : input_(input) {}

    PlyLayout make() {
        layout_.bytesPerPoint = 3 * sizeof(double);
        for (std::size_t i = 0; i < input_.attributes.size(); ++i)
            for (int c = 0; c < input_.attribute(i).components; ++c)
                add(i, c);
        return std::move(layout_);
    }

  private:
    void add(std::size_t column, int component) {
        const Attribute& attribute = input_.attribute(column);
        std::string name = propertyName(attribute);
        if (attribute.components > 1)
            name += cat("_", component);
        bool isWide = attribute.type == AttributeType::u64 || attribute.type == AttributeType::i64;
        if (attribute.scale != 1 || attribute.offset != 0) {
            const std::string& used = put(name, "double", 8, column, component, Form::physical);
            note(used, attribute,
                 cat("is ", attribute.offset, " + ", attribute.scale, " * the stored ",
                     attributeTypeName(attribute.type), attribute.noData ? "; nan is no value" : ""));
        } else if (isWide && fitsDouble(column)) {
            note(put(name, "double", 8, column, component, Form::asDouble), attribute,
                 cat("was stored as ", attributeTypeName(attribute.type)));
        } else if (isWide) {
            bool isSigned = attribute.type == AttributeType::i64;
            put(name + "_low", "uint", 4, column, component, Form::low);
            note(put(name + "_high", isSigned ? "int" : "uint", 4, column, component, Form::high), attribute,
                 "* 2^32 + the one before is the stored value");
        } else if (input_.metadata.colourIs8Bit && isColour(attribute.name) &&
                   attribute.type == AttributeType::u16 && attribute.components == 1) {
            put(name, "uchar", 1, column, component, Form::lowByte);
        } else {
            const std::string& used = put(name, plyType(attribute.type), attributeTypeSize(attribute.type),
                                          column, component, Form::stored);
            if (attribute.noData)
                note(used, attribute, cat("has ", *attribute.noData, " for no value"));
            else if (used != attribute.name && !isLasName(attribute.name))
                note(used, attribute, "");
        }
    }

    bool fitsDouble(std::size_t column) const {
        auto a = static_cast<std::size_t>(input_.attributes[column]);
        if (a >= input_.metadata.statistics.size())
            return false;
        const AttributeStatistics& statistics = input_.metadata.statistics[a];
        return statistics.min >= -exactInDouble && statistics.max < exactInDouble;
    }

    const std::string& put(const std::string& name, const char* type, std::size_t size, std::size_t column,
                           int component, Form form) {
        auto isTaken = [&](const std::string& wanted) {
            return wanted == "x" || wanted == "y" || wanted == "z" ||
                   std::any_of(layout_.properties.begin(), layout_.properties.end(),
                               [&](const WrittenPlyProperty& p) { return p.name == wanted; });
        };
        std::string unique = name;
        for (int i = 2; isTaken(unique); ++i)
            unique = cat(name, "_", i);
        layout_.properties.push_back({unique, type, size, column, component, form});
        layout_.bytesPerPoint += size;
        return layout_.properties.back().name;
    }

    void note(const std::string& property, const Attribute& attribute, const std::string& what) {
        std::string name = attribute.name;
        for (char& c : name)
            if (static_cast<unsigned char>(c) < ' ')
                c = ' ';
        layout_.comments.push_back(
            cat("property ", property, " (\"", name, "\")", what.empty() ? "" : " ", what));
    }

    const SinkInput& input_;
    PlyLayout layout_;
};

// `convert` turns a stored value into what the record holds.
template <class T, class Convert>
void convertAll(const WrittenPlyProperty& property, const Attribute& attribute, const Bytes& column,
                std::uint8_t* to, std::size_t stride, std::size_t count, Convert convert) {
    const std::uint8_t* from = column.data() + static_cast<std::size_t>(property.component) * sizeof(T);
    std::size_t step = attribute.size();
    for (std::size_t i = 0; i < count; ++i)
        storeLe(to + i * stride, convert(loadLe<T>(from + i * step)));
}

template <class T>
void putAs(const WrittenPlyProperty& property, const Attribute& attribute, const Bytes& column,
           std::uint8_t* to, std::size_t stride, std::size_t count) {
    auto all = [&](auto convert) { convertAll<T>(property, attribute, column, to, stride, count, convert); };
    switch (property.form) {
    case Form::stored:
        return all([](T value) { return value; });
    case Form::lowByte:
        return all([](T value) { return static_cast<std::uint8_t>(value); });
    case Form::asDouble:
        return all([](T value) { return static_cast<double>(value); });
    case Form::physical:
        return all([&](T value) {
            auto stored = static_cast<double>(value);
            return attribute.noData && stored == *attribute.noData
                       ? std::numeric_limits<double>::quiet_NaN()
                       : attribute.offset + attribute.scale * stored;
        });
    case Form::low:
        return all([](T value) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(value)); });
    case Form::high:
        return all(
            [](T value) { return static_cast<std::uint32_t>(static_cast<std::uint64_t>(value) >> 32); });
    }
}

} // namespace

PlyLayout plyLayout(const SinkInput& input) {
    return LayoutMaker(input).make();
}

Status putProperty(const WrittenPlyProperty& property, const Attribute& attribute, const Bytes& column,
                   std::uint8_t* to, std::size_t stride, std::size_t count) {
    if (property.form == Form::lowByte) {
        unsigned all = 0;
        for (std::size_t i = 0; i < count; ++i)
            all |= loadLe<std::uint16_t>(column.data() + 2 * i);
        if (all > 255)
            return Error{ErrorCode::outOfRange,
                         cat("the cloud says its colours have 8 bits, but ", attribute.name, " has more"), "",
                         "convert the scan again"};
    }
    auto as = [&](auto type) {
        putAs<decltype(type)>(property, attribute, column, to, stride, count);
        return Status();
    };
    switch (attribute.type) {
    case AttributeType::u8:
        return as(std::uint8_t{});
    case AttributeType::i8:
        return as(std::int8_t{});
    case AttributeType::u16:
        return as(std::uint16_t{});
    case AttributeType::i16:
        return as(std::int16_t{});
    case AttributeType::u32:
        return as(std::uint32_t{});
    case AttributeType::i32:
        return as(std::int32_t{});
    case AttributeType::u64:
        return as(std::uint64_t{});
    case AttributeType::i64:
        return as(std::int64_t{});
    case AttributeType::f32:
        return as(float{});
    case AttributeType::f64:
        return as(double{});
    }
    return {};
}

} // namespace stipple
