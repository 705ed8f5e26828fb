#include "server/api/class_names.hpp"

#include <array>

namespace stipple::server {

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

} // namespace stipple::server
