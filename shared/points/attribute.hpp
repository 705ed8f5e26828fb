// What a point carries besides its position. Attributes keep the names, types and exact values of LAS
// 1.4 (tables 7-18; "extra bytes" §2.6.4); names are written as there: "Intensity", "GPS Time", "Red".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

enum class AttributeType : std::uint8_t { u8, i8, u16, i16, u32, i32, u64, i64, f32, f64 };

std::size_t attributeTypeSize(AttributeType type);
const char* attributeTypeName(AttributeType type); // "uint8", "int8", …, "float32", "float64"
std::optional<AttributeType> attributeTypeFromName(std::string_view name);

struct Attribute {
    std::string name; // unique in a schema
    AttributeType type = AttributeType::u8;
    int components = 1;        // 1..255; > 1 for undescribed extra bytes and LAS 1.0-1.3 tuples
    std::string description{}; // of extra bytes; else empty
    std::string unit{};        // "s", "deg"; empty where unknown
    // value = offset + scale × stored, for described extra bytes and the scaled angle of formats 6-10.
    double scale = 1;
    double offset = 0;
    std::optional<double> noData{}; // stored value that means "no value"

    std::size_t size() const { return attributeTypeSize(type) * static_cast<std::size_t>(components); }
    friend bool operator==(const Attribute&, const Attribute&) = default;
};

// The attributes of a cloud in order. Position is not among them.
struct Schema {
    std::vector<Attribute> attributes;

    // Index of the attribute of that name, or -1.
    int find(std::string_view name) const {
        for (std::size_t i = 0; i < attributes.size(); ++i)
            if (attributes[i].name == name)
                return static_cast<int>(i);
        return -1;
    }
    std::size_t bytesPerPoint() const {
        std::size_t sum = 0;
        for (const Attribute& attribute : attributes)
            sum += attribute.size();
        return sum;
    }
    friend bool operator==(const Schema&, const Schema&) = default;
};

// Names that code, not only people, looks for.
namespace attribute_names {
inline constexpr std::string_view intensity = "Intensity";
inline constexpr std::string_view returnNumber = "Return Number";
inline constexpr std::string_view numberOfReturns = "Number of Returns";
inline constexpr std::string_view scanDirectionFlag = "Scan Direction Flag";
inline constexpr std::string_view edgeOfFlightLine = "Edge of Flight Line";
inline constexpr std::string_view classification = "Classification";
inline constexpr std::string_view synthetic = "Synthetic";
inline constexpr std::string_view keyPoint = "Key-point";
inline constexpr std::string_view withheld = "Withheld";
inline constexpr std::string_view overlap = "Overlap";
inline constexpr std::string_view scannerChannel = "Scanner Channel";
inline constexpr std::string_view scanAngleRank = "Scan Angle Rank"; // formats 0-5: int8, degrees
inline constexpr std::string_view scanAngle = "Scan Angle";          // formats 6-10: int16, 0.006 degrees
inline constexpr std::string_view userData = "User Data";
inline constexpr std::string_view pointSourceId = "Point Source ID";
inline constexpr std::string_view gpsTime = "GPS Time";
inline constexpr std::string_view red = "Red";
inline constexpr std::string_view green = "Green";
inline constexpr std::string_view blue = "Blue";
inline constexpr std::string_view nir = "NIR";
inline constexpr std::string_view wavePacketDescriptorIndex = "Wave Packet Descriptor Index";
inline constexpr std::string_view waveformDataOffset = "Byte Offset to Waveform Data";
inline constexpr std::string_view waveformPacketSize = "Waveform Packet Size";
inline constexpr std::string_view returnPointWaveformLocation = "Return Point Waveform Location";
inline constexpr std::string_view parametricDx = "Parametric dx";
inline constexpr std::string_view parametricDy = "Parametric dy";
inline constexpr std::string_view parametricDz = "Parametric dz";
inline constexpr std::string_view extraBytes = "Extra Bytes"; // undescribed: u8 × k
} // namespace attribute_names

} // namespace stipple
