#include "shared/points/attribute.hpp"

#include <array>

namespace stipple {

namespace {
struct TypeRow {
    const char* name;
    std::size_t size;
};
// In the order of AttributeType.
constexpr std::array<TypeRow, 10> typeRows{{{"uint8", 1},
                                            {"int8", 1},
                                            {"uint16", 2},
                                            {"int16", 2},
                                            {"uint32", 4},
                                            {"int32", 4},
                                            {"uint64", 8},
                                            {"int64", 8},
                                            {"float32", 4},
                                            {"float64", 8}}};
} // namespace

std::size_t attributeTypeSize(AttributeType type) {
    return typeRows[static_cast<std::size_t>(type)].size;
}

const char* attributeTypeName(AttributeType type) {
    return typeRows[static_cast<std::size_t>(type)].name;
}

std::optional<AttributeType> attributeTypeFromName(std::string_view name) {
    for (std::size_t i = 0; i < typeRows.size(); ++i)
        if (name == typeRows[i].name)
            return static_cast<AttributeType>(i);
    return std::nullopt;
}

} // namespace stipple
