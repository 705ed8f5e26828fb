// Units of length that results are shown in. Clouds keep the unit of their coordinate system.
#pragma once

#include <string_view>

namespace stipple::survey {

// Metres of one, exactly as defined: EPSG 9001, 9002, 9003.
inline constexpr double metre = 1;
inline constexpr double foot = 0.3048;
inline constexpr double surveyFoot = 1200.0 / 3937.0; // US; 2 parts in a million longer

// `length` in units of `from` metres, as units of `to` metres; `power` 2 for areas, 3 for volumes.
constexpr double convertUnits(double number, double from, double to, int power = 1) {
    for (int i = 0; i < power; ++i)
        number = number * from / to;
    return number;
}

} // namespace stipple::survey
