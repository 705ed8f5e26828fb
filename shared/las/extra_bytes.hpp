// Extra bytes: what a point record holds after its format's fields, described by the records LASF_Spec 4
// (LAS 1.4 R15 §2.6.4). A descriptor is 192 bytes:
//
//   0 reserved u16   3 options u8: no_data, min, max, scale, offset   40 no_data 3×8   112 scale 3×f64
//   2 data type u8   4 name [32]   36 unused [4]                      64 min, 88 max   136 offset 3×f64
//                                                                                      160 description [32]
//
// no_data, min and max are u64, i64 or f64 by the kind of the type. Types: 0 undescribed, `options` bytes;
// 1-10 u8 … f64 in the order of AttributeType; 11-20 and 21-30 (deprecated) two and three of them.
#pragma once

#include "shared/base/result.hpp"
#include "shared/las/record_layout.hpp"

#include <array>
#include <span>
#include <string>
#include <vector>

namespace stipple::las {

inline constexpr std::size_t extraBytesDescriptorSize = 192;

// Appends the extra bytes of a record of `recordLength` bytes to `layout` (a base layout). What
// `descriptors` do not cover becomes "Extra Bytes", u8 × k (in parts of at most 255). Descriptors that
// cover more than there is, unknown types and odd values become warnings; names are made unique.
void addExtraBytes(RecordLayout& layout, std::size_t recordLength, ByteSpan descriptors,
                   std::vector<std::string>& warnings);

// Smallest and largest value of each component (up to 3), as descriptors state them.
struct ValueRange {
    struct Limits {
        std::uint64_t minBits = 0, maxBits = 0; // u64, i64 or f64 by the kind of the type
        bool known = false;                     // false until a value that is not no-data has been seen
        friend bool operator==(const Limits&, const Limits&) = default;
    };
    std::array<Limits, 3> component;
    friend bool operator==(const ValueRange&, const ValueRange&) = default;
};

// Widens `range` by the values of a column.
void extendRange(ValueRange& range, const Attribute& attribute, ByteSpan column);

// The descriptor of an attribute. invalidArgument if LAS has no type for it.
Result<Bytes> encodeDescriptor(const Attribute& attribute, const ValueRange& range);

// An attribute's name in the 32 bytes a descriptor has, cut between characters.
std::string descriptorName(const std::string& name);

// Is it one of the parts of the undescribed remainder, as addExtraBytes names them?
bool isUndescribed(const Attribute& attribute);

} // namespace stipple::las
