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
    double least = 0, most = 0;                     // count (below 2^53), number
    std::string_view form = {};                     // numbers: "x,y,z|x,y" (query.hpp)
    std::span<const std::string_view> choices = {}; // choice
    std::string_view example = {};                  // a value that any cloud answers
    bool isRequired = false;
    std::string_view usual = {};   // what is meant where it is not given, written as it would be; empty: none
    std::string_view needs = {};   // others that have to be given with it, as a query: "size=2,2"
    std::string_view pattern = {}; // text: a regular expression (ECMA-262) that every value matches
};

// The getters of Query by a row.
inline Result<std::optional<std::uint64_t>> countOf(const Query& query, const Parameter& parameter) {
    return query.count(parameter.name, static_cast<std::uint64_t>(parameter.least),
                       static_cast<std::uint64_t>(parameter.most));
}
inline Result<std::optional<double>> numberOf(const Query& query, const Parameter& parameter) {
    return query.number(parameter.name, parameter.least, parameter.most);
}
inline Result<std::optional<std::vector<double>>> numbersOf(const Query& query, const Parameter& parameter) {
    return query.numbers(parameter.name, parameter.form);
}
inline Result<std::optional<std::size_t>> choiceOf(const Query& query, const Parameter& parameter) {
    return query.choice(parameter.name, parameter.choices);
}

} // namespace stipple::server
