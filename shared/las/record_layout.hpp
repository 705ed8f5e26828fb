// Where each attribute lies in a point record (LAS 1.4 R15 tables 7-18). Reading and writing share this
// table; the loops over it are in record_codec.hpp.
#pragma once

#include "shared/las/las_header.hpp"

#include <optional>
#include <vector>

namespace stipple::las {

struct RecordField {
    std::size_t attribute = 0;   // index into RecordLayout::schema
    std::size_t offsetBytes = 0; // from the record's first byte
    std::size_t sizeBytes = 0;   // of the attribute; 1 for bit fields
    int shift = 0;               // bit fields: lowest bit
    int bits = 0;                // bit fields: width; 0: whole bytes
};

// X, Y, Z are always int32 at bytes 0, 4 and 8; the fields are everything else.
struct RecordLayout {
    int pointFormat = 0;
    std::size_t recordLength = 0; // 0..65535, extra bytes included
    Schema schema;
    std::vector<RecordField> fields;
};

// Fields of format 0..10 without extra bytes, in record order.
RecordLayout baseLayout(int pointFormat);

// A field of the base format by its attribute's name, e.g. "Withheld" in format 3: bit 7 of byte 15.
std::optional<RecordField> findField(const RecordLayout& layout, std::string_view name);

} // namespace stipple::las
