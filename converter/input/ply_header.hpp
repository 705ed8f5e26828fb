// Headers of PLY files ("The PLY Polygon File Format", G. Turk, 1994). Names of types as there ("float") and
// as many programs write them ("float32").
#pragma once

#include "converter/input/file_cursor.hpp"
#include "shared/points/attribute.hpp"

#include <optional>

namespace stipple {

struct PlyProperty {
    std::string name;
    AttributeType type = AttributeType::f32;    // of a value
    std::optional<AttributeType> listCountType; // of a list; else nothing
};

struct PlyElement {
    std::string name;
    std::uint64_t count = 0;
    std::vector<PlyProperty> properties;
};

enum class PlyEncoding : std::uint8_t { ascii, littleEndian, bigEndian };

struct PlyHeader {
    PlyEncoding encoding = PlyEncoding::ascii;
    std::vector<PlyElement> elements;
    std::uint64_t bodyOffset = 0; // byte behind "end_header" and its line end
    std::uint64_t bodyLine = 1;   // number of the line that begins there
};

// Errors name the file and the line: a line of no known kind, a type or format that does not exist, no
// "end_header", no element "vertex" or several.
Result<PlyHeader> readPlyHeader(SharedSource& source);

} // namespace stipple
