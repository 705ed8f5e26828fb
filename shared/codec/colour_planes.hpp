// What the codecs of colours share: channels as planes of bytes, in the order and the unit of the format.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/section.hpp"

#include <span>

namespace stipple {

// Green comes first; red and blue are stored as what their residual differs from green's.
inline constexpr std::size_t channelOrder[3] = {1, 0, 2};

inline std::uint32_t unitOf(ColourWidth width) {
    return width == ColourWidth::high ? 256 : width == ColourWidth::repeated ? 257 : 1;
}
// A value of that width divided by its unit is the value shifted so far.
inline int shiftOf(ColourWidth width) {
    return width == ColourWidth::high || width == ColourWidth::repeated ? 8 : 0;
}

// A section of the values' low bytes, and one of their high bytes if they have any.
template <class T>
void writePlane(ByteWriter& to, std::span<const T> values) {
    Bytes part(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        for (std::size_t j = 0; j < part.size(); ++j)
            part[j] = static_cast<std::uint8_t>(values[j] >> (8 * byte));
        writeSection(to, part, Effort::literals);
    }
}

} // namespace stipple
