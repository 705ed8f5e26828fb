// The XML section of an E57 file (ASTM E2807-11 §8): what scans there are, where their records lie, and how
// each record is packed.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/geometry/box.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::e57 {

inline constexpr std::uint64_t maxXmlBytes = std::uint64_t{32} << 20;
inline constexpr std::size_t maxFields = 256; // of one scan's records

enum class FieldKind : std::uint8_t { integer, scaledInteger, float32, float64, text };

// One number (or text) of a record: a leaf of the prototype.
struct Field {
    std::string name; // "cartesianX", "nor:normalX"; of leaves in structures the path, "a/b"
    FieldKind kind = FieldKind::float64;
    // Of the integers, which are packed as `stored` - minimum in `bits` bits.
    std::int64_t minimum = 0, maximum = 0;
    double scale = 1, offset = 0; // of scaled integers: value = offset + scale × stored
    int bits = 64;                // that a record has of it, 0..64; text: 0, its length varies

    bool isFloat() const { return kind == FieldKind::float32 || kind == FieldKind::float64; }
    bool isInteger() const { return kind == FieldKind::integer || kind == FieldKind::scaledInteger; }
};

struct Range {
    double min = 0, max = 0;
};

// From a scan's frame into the file's: rotated, then moved (§8.4.12).
struct Pose {
    std::array<double, 9> rotation{1, 0, 0, 0, 1, 0, 0, 0, 1}; // rows
    Vec3d translation;
    bool rotates = false;

    Vec3d apply(Vec3d p) const {
        if (rotates)
            p = {rotation[0] * p.x + rotation[1] * p.y + rotation[2] * p.z,
                 rotation[3] * p.x + rotation[4] * p.y + rotation[5] * p.z,
                 rotation[6] * p.x + rotation[7] * p.y + rotation[8] * p.z};
        return p + translation;
    }
};

struct ScanEntry {
    int number = 0; // in data3D, from 1
    std::string name;
    bool hasPoints = false;       // the rest is empty where it has none
    std::uint64_t fileOffset = 0; // physical, of the binary section
    std::uint64_t recordCount = 0;
    std::vector<Field> fields; // in the order of the byte streams
    Pose pose;
    std::optional<Range> intensityLimits;
    std::array<std::optional<Range>, 3> colourLimits; // red, green, blue
    std::optional<BoxD> cartesianBounds;              // in the scan's frame
    std::optional<double> acquisitionStart;           // seconds of GPS time

    int find(std::string_view field) const {
        for (std::size_t i = 0; i < fields.size(); ++i)
            if (fields[i].name == field)
                return static_cast<int>(i);
        return -1;
    }
};

struct Document {
    std::string coordinateMetadata; // a WKT, or empty
    std::vector<ScanEntry> scans;
    std::size_t pictures = 0; // of images2D
    std::vector<std::string> warnings;
};

// `xmlOffset` (logical) is where the text lies in the file, for messages. Errors: `corrupt` where it is no
// XML, or contradicts itself; `unsupported` for codecs other than bit packing.
Result<Document> parseDocument(ByteSpan xml, std::uint64_t xmlOffset);

} // namespace stipple::e57
