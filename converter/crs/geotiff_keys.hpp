// The GeoTIFF keys of a LAS file, made safe to hand to libgeotiff: a directory of 16-bit numbers
// (OGC GeoTIFF 1.1 §7.1.2) and the arrays of doubles and characters it points into.
#pragma once

#include "shared/las/las_header.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple {

struct GeoKey {
    std::uint16_t id = 0;
    std::uint16_t tag = 0;   // 0: `value` is the value; else the array it lies in
    std::uint16_t count = 1; // values, or characters
    std::uint16_t value = 0; // or the first index in the array
};

struct GeoKeys {
    std::vector<GeoKey> keys; // ascending ids; every reference lies inside its array
    std::vector<double> doubles;
    std::string characters;

    bool empty() const { return keys.empty(); }
    // The value of a key that is a number in the directory, or -1.
    int number(std::uint16_t id) const;
    // The directory as libgeotiff reads it: version 1.1.0, count, then four numbers a key.
    std::vector<std::uint16_t> directory() const;
};

// Takes what is sound; drops padding, unsorted doubles and references out of range with a warning each.
GeoKeys geoKeysOf(const las::Header& header, std::vector<std::string>& warnings);

} // namespace stipple
