// The parameters of endpoints as rows of a table: what they are called, what they mean and which values they
// take. What reads them and what describes them (/api/v1/openapi.json) both go by the row.
#pragma once

#include "server/api/query.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace stipple::server {

enum class ParameterKind : std::uint8_t {
    text,
    count,   // whole number in [least, most]
    number,  // finite number in [least, most]
    numbers, // finite numbers joined by commas, as `form` shows
    choice,  // one of `choices`
};

struct Parameter {
    std::string_view name;
    std::string_view description; // for people; what is so where it is not given
    ParameterKind kind = ParameterKind::text;
    double least = 0, most = 0;                     // count, number; whole numbers below 2^53
    std::string_view form = {};                     // numbers: "x,y,z|x,y" (query.hpp)
    std::span<const std::string_view> choices = {}; // choice
    std::string_view example = {};                  // a value that any cloud answers
    bool isRequired = false;
};

} // namespace stipple::server
