// Colour gradients: one table that the software renderer indexes and the shaders sample, so both give the
// same colour. Stops are interpolated linearly in sRGB.
#pragma once

#include "client/core/style.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace stipple {

// Enough that two neighbouring entries differ by at most four levels of 255 in any gradient.
inline constexpr int gradientEntries = 1024;

// R | G << 8 | B << 16 | 255 << 24, from low values to high.
using GradientTable = std::array<std::uint32_t, gradientEntries>;

// Lives as long as the program. Thread: any.
const GradientTable& gradientTable(GradientName name);

// Whether values stay in order for people with red-green or blue-yellow colour blindness: lightness rises
// all the way.
bool isColourBlindSafe(GradientName name);

const char* gradientNameText(GradientName name); // "viridis", …
std::optional<GradientName> gradientFromText(std::string_view text);

} // namespace stipple
