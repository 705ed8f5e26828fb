#include "shared/points/point_classes.hpp"

#include <algorithm>
#include <cmath>

namespace stipple {

namespace {

constexpr std::array<std::string_view, 23> names{"Created, Never Classified",
                                                 "Unclassified",
                                                 "Ground",
                                                 "Low Vegetation",
                                                 "Medium Vegetation",
                                                 "High Vegetation",
                                                 "Building",
                                                 "Low Point (Noise)",
                                                 "Reserved",
                                                 "Water",
                                                 "Rail",
                                                 "Road Surface",
                                                 "Reserved",
                                                 "Wire - Guard (Shield)",
                                                 "Wire - Conductor (Phase)",
                                                 "Transmission Tower",
                                                 "Wire-Structure Connector",
                                                 "Bridge Deck",
                                                 "High Noise",
                                                 "Overhead Structure",
                                                 "Ignored Ground",
                                                 "Snow",
                                                 "Temporal Exclusion"};
constexpr int firstOfUsers = 64;

// Of the same values.
constexpr std::array<std::array<std::uint8_t, 3>, names.size()> colours{
    {{128, 128, 128}, {190, 190, 190}, {161, 111, 66},  {148, 200, 90},  {74, 165, 62},  {22, 110, 48},
     {214, 69, 58},   {230, 60, 220},  {245, 205, 130}, {62, 126, 220},  {120, 80, 150}, {90, 96, 106},
     {250, 150, 170}, {255, 225, 60},  {255, 190, 0},   {245, 130, 32},  {200, 160, 20}, {60, 190, 190},
     {255, 0, 150},   {140, 60, 60},   {110, 80, 60},   {240, 248, 255}, {100, 60, 200}}};

// Up to point format 5 five bits hold the class.
std::string_view legacyName(int value) {
    constexpr int modelKeyPoint = 8, overlap = 12, lastSame = 9;
    if (value == modelKeyPoint)
        return "Model Key-Point (Mass Point)";
    if (value == overlap)
        return "Overlap";
    return value <= lastSame ? names[static_cast<std::size_t>(value)] : "Reserved";
}

} // namespace

std::string_view className(const Schema& schema, int value) {
    if (value < 0 || value > 255)
        return "Unknown";
    if (schema.find(attribute_names::scannerChannel) < 0 && value < 32)
        return legacyName(value);
    if (value < static_cast<int>(names.size()))
        return names[static_cast<std::size_t>(value)];
    return value < firstOfUsers ? "Reserved" : "User Definable";
}

std::array<std::uint8_t, 3> classColour(std::uint8_t value) {
    if (value < colours.size())
        return colours[value];
    // Steps of the golden ratio around the circle of hues: neighbours are far apart.
    double hue = std::fmod(0.15 + value * 0.6180339887498949, 1.0) * 6;
    auto channel = [&](double peak) {
        double apart = std::abs(hue - peak);
        apart = std::min(apart, 6 - apart);
        return static_cast<std::uint8_t>(70 + 160 * std::clamp(2 - apart, 0.0, 1.0));
    };
    return {channel(0), channel(2), channel(4)};
}

} // namespace stipple
