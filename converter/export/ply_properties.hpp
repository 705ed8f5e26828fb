// How the attributes of a cloud become properties of a PLY vertex.
#pragma once

#include "shared/sinks/point_sink.hpp"

#include <string>
#include <vector>

namespace stipple {

struct WrittenPlyProperty {
    enum class Form : std::uint8_t {
        stored,   // as it is
        lowByte,  // the lower byte of a u16 that is below 256
        physical, // offset + scale × stored, as double
        asDouble, // a 64-bit integer that double holds
        low,
        high, // halves of a 64-bit integer
    };
    std::string name;
    const char* type = ""; // PLY's name for it
    std::size_t size = 0;  // bytes in a vertex
    std::size_t column = 0;
    int component = 0;
    Form form = Form::stored;
};

struct PlyLayout {
    std::vector<WrittenPlyProperty> properties; // those after x, y and z
    std::vector<std::string> comments;          // what the names do not say
    std::size_t bytesPerPoint = 0;              // x, y and z included
};

PlyLayout plyLayout(const SinkInput& input);

// Values of `count` points from `column` into records `stride` bytes apart. outOfRange where a lowByte is
// no byte.
Status putProperty(const WrittenPlyProperty& property, const Attribute& attribute, const Bytes& column,
                   std::uint8_t* to, std::size_t stride, std::size_t count);

} // namespace stipple
