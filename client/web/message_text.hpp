// A text in a message between the page and a worker: its length in bytes (u32), and its bytes.
#pragma once

#include "shared/base/bytes.hpp"

#include <algorithm>
#include <string>

namespace stipple::web {

inline constexpr std::size_t maxTextBytes = 1 << 16; // longer ones are cut

inline void writeText(ByteWriter& out, const std::string& text) {
    std::size_t size = std::min(text.size(), maxTextBytes);
    out.write(static_cast<std::uint32_t>(size));
    out.writeBytes({reinterpret_cast<const std::uint8_t*>(text.data()), size});
}

inline std::string readText(ByteReader& in) {
    ByteSpan part = in.readBytes(in.read<std::uint32_t>());
    return {reinterpret_cast<const char*>(part.data()), part.size()};
}

} // namespace stipple::web
