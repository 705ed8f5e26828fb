// What the values of the attribute Classification are called, and the colours they are shown in: the one
// table that drawing, the page, the server's answers and the reference renderer use.
#pragma once

#include "shared/points/attribute.hpp"

#include <array>
#include <cstdint>
#include <string_view>

namespace stipple {

// LAS 1.4 R15, table 17 (point formats 6-10) or table 9 (0-5), whichever the attributes come from.
std::string_view className(const Schema& schema, int value);

// Red, green, blue of class `value` in either table. The LAS specification names no colours; these are the
// project's: ground brown, vegetation green, buildings red, water blue, noise magenta. Values without a
// meaning of their own (reserved, user definable) have colours that differ from their neighbours'.
std::array<std::uint8_t, 3> classColour(std::uint8_t value);

} // namespace stipple
