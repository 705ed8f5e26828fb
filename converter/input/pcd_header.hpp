// Headers of PCD files, versions 0.5 to 0.7 (Point Cloud Library, "The PCD file format").
#pragma once

#include "converter/input/file_cursor.hpp"
#include "shared/points/attribute.hpp"

namespace stipple {

struct PcdField {
    std::string name; // "_": padding
    AttributeType type = AttributeType::f32;
    int count = 1; // values of a point

    std::size_t bytes() const { return attributeTypeSize(type) * static_cast<std::size_t>(count); }
    bool isPadding() const { return name == "_"; }
};

enum class PcdEncoding : std::uint8_t { ascii, binary, compressed };

struct PcdHeader {
    PcdEncoding encoding = PcdEncoding::ascii;
    std::vector<PcdField> fields;
    std::uint64_t points = 0;
    std::string viewpoint; // as it stands there; empty: none, or the origin without a rotation
    std::uint64_t bodyOffset = 0;
    std::uint64_t bodyLine = 1;
};

// Errors name the file and the line: a missing or doubled line, lists of different lengths, types that do not
// exist, a POINTS that is not WIDTH × HEIGHT, no DATA.
Result<PcdHeader> readPcdHeader(SharedSource& source);

} // namespace stipple
