// What a `.stipple` file says about itself: the JSON block after the header (docs/FORMAT.md, "Metadata").
#pragma once

#include "shared/geometry/box.hpp"
#include "shared/geometry/grid.hpp"
#include "shared/geometry/node_key.hpp"
#include "shared/points/attribute.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace stipple {

struct CrsAxis {
    std::string name;      // "Easting"
    std::string direction; // "east"
    std::string unit;      // "metre"
    double unitMeters = 0; // 0 where angular
    friend bool operator==(const CrsAxis&, const CrsAxis&) = default;
};

// Coordinate reference system. Empty `wkt` and no `epsg`: none is known.
struct Crs {
    std::string name;        // "WGS 84 / UTM zone 10N"
    std::string wkt;         // as the source states it, or derived from its GeoTIFF keys
    std::optional<int> epsg; // of the horizontal or compound system, where known
    std::string proj;        // PROJ string, where known
    std::string unit;        // name of the horizontal axes' unit: "metre", "US survey foot", "degree"
    double unitMeters = 0;   // metres in one unit; 0 where unknown or angular
    std::string vertical;    // name of the vertical system, where the definition has one: "NAVD88 height"
    // What the points' x, y and, where the definition says, z are. East comes first, as in LAS, also where
    // the definition has north first. Empty where unknown.
    std::vector<CrsAxis> axes;

    bool known() const { return !wkt.empty() || epsg.has_value(); }
    friend bool operator==(const Crs&, const Crs&) = default;
};

// One attribute over the whole cloud. For several components min…deviation span all of them.
struct AttributeStatistics {
    double min = 0, max = 0, mean = 0, deviation = 0;
    // Value → number of points; kept for one-component integer attributes of at most 256 distinct values.
    std::vector<std::pair<std::int64_t, std::uint64_t>> histogram;
    friend bool operator==(const AttributeStatistics&, const AttributeStatistics&) = default;
};

// The colour that travels with positions in a node's strata.
enum class PictureColour : std::uint8_t { none, rgb, intensity };
inline constexpr std::array<const char*, 3> pictureColourNames{"none", "rgb", "intensity"};

// What the picture of an inner node shows: its points' own colours, or the mean colour of the area that each
// stands for (converter/build/mean_colour.hpp). Then the exact ones are in a block of their own.
enum class InnerColour : std::uint8_t { exact, mean };
inline constexpr std::array<const char*, 2> innerColourNames{"exact", "mean"};

// How the points of inner nodes were chosen among those below (converter/build/chooser.hpp). Only `poisson`
// keeps a minimum distance between the points of a node.
enum class Sampling : std::uint8_t { poisson, random, grid };
inline constexpr std::array<const char*, 3> samplingNames{"poisson", "random", "grid"};

struct SourceFile {
    std::string name;   // file name without folders
    std::string format; // "LAS 1.2, point format 2"
    std::uint64_t pointCount = 0;
    std::uint64_t sizeBytes = 0;
    // PointHash of its points as the file has them: on its own grid and with its own attributes, whatever the
    // cloud makes of them. Hex; empty where it is not known.
    std::string pointHash = {};
    friend bool operator==(const SourceFile&, const SourceFile&) = default;
};

struct CloudMetadata {
    std::string name;
    Crs crs;
    Grid grid;
    RootCube rootCube;
    // Of points in the root node, world units; halves with each level: their minimum distance (poisson), the
    // width of the cells that are given a point (grid), or were there a point for each (random).
    double spacing = 0;
    Sampling sampling = Sampling::poisson;
    BoxI bounds; // of all points, grid integers; empty for an empty cloud
    std::uint64_t pointCount = 0;
    Schema schema;
    std::vector<AttributeStatistics> statistics; // parallel to schema.attributes
    PictureColour pictureColour = PictureColour::none;
    InnerColour innerColour = InnerColour::exact;
    bool colourIs8Bit = false; // Red, Green, Blue are 16-bit fields that hold 0..255
    // Order-independent sum over all points' integers and attributes (shared/format/point_hash.hpp), hex.
    std::string pointHash;
    std::vector<SourceFile> sources;
    std::string tool;    // "stipple 0.1.0"
    std::string options; // options of the conversion, as text

    BoxD worldBounds() const {
        BoxD box;
        if (!bounds.empty()) {
            box.extend(grid.toWorld(bounds.min));
            box.extend(grid.toWorld(bounds.max));
        }
        return box;
    }
};

} // namespace stipple
