// Pictures that error measures are tested with; tests/oracles/pictures.mjs makes the same ones for other
// implementations, whose values are in tests/oracles/measures.json.
#pragma once

#include "client/render/image.hpp"

#include <nlohmann/json.hpp>

#include <array>
#include <string>

namespace stipple::test {

using Rgb = std::array<int, 3>;

Image constantPicture(Rgb colour, int width = 32, int height = 24);
// "base", "noise", "shift", "dots" or "tint"; grey: the mean of the channels, rounded down.
Image samplePicture(const std::string& name, bool grey = false);

nlohmann::json oracleMeasures();

} // namespace stipple::test
