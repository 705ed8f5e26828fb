// What the records of a file's scans hold besides coordinates, as attributes of points.
//
//   intensity                    Intensity           uint16: as stated where it is an integer of 16 bits,
//   else
//                                                    its limits stretched to 0..65535, and "intensity" beside
//                                                    it as stated
//   colorRed, Green, Blue        Red, Green, Blue    uint16: as stated (0..255 or 0..65535), else stretched
//                                                    and beside it as stated
//   returnIndex, returnCount     Return Number, Number of Returns    uint8, from 1
//   timeStamp                    GPS Time            acquisitionStart + timeStamp, as adjusted standard time
//   the scan's number, from 1    Point Source ID
//   classification               Classification      if of 8 bits
//   everything else              its own name        the smallest type that holds it; scaled integers keep
//   scale
//                                                    and offset
//
// A colour, intensity or time that a record marks as invalid is 0. Text is left out.
#pragma once

#include "converter/input/e57/coordinates.hpp"

namespace stipple::e57 {

// How the records of one scan give an attribute.
struct AttributeSource {
    enum class How : std::uint8_t {
        constant, // add
        integer,  // add + multiply × stored
        number,   // shift + value
        stretched // value from `range` to 0..full
    };
    How how = How::constant;
    std::size_t field = 0;
    int invalid = -1; // field that is not 0 where the value is none
    std::int64_t add = 0, multiply = 1;
    double shift = 0;
    Range range;
    double full = 65535;
};

struct AttributePlan {
    Schema schema;
    std::vector<std::vector<AttributeSource>> sources; // [scan][attribute]
    GpsTimeKind gpsTime = GpsTimeKind::unknown;
    std::vector<std::string> warnings;

    // The fields that a scan's sources need, ascending.
    std::vector<std::size_t> fieldsOf(std::size_t scan) const;
};

// Fields whose range has to be measured, as no limits state what to stretch: of each scan.
std::vector<std::vector<std::size_t>> fieldsToMeasure(const std::vector<const ScanEntry*>& scans);

// measured[scan][field] where fieldsToMeasure named it and the scan has such values.
using MeasuredRanges = std::vector<std::vector<std::optional<Range>>>;

AttributePlan planAttributes(const std::vector<const ScanEntry*>& scans,
                             const std::vector<CoordinateFields>& coordinates,
                             const MeasuredRanges& measured);

// The attribute's values for `rows` of the columns, as raw bytes.
void fillAttribute(const Attribute& attribute, const AttributeSource& source, const ScanEntry& scan,
                   const std::vector<Column>& columns, const std::vector<std::uint32_t>& rows, Bytes& out);

} // namespace stipple::e57
