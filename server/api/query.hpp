// The query of a request (RFC 3986 §3.4) as parameters, read strictly: what could be read in two ways, or
// would be ignored, is refused, so that a mistyped address never answers something else than was meant.
//
//   name=value&name=value    percent-encoded; "+" is a space, as forms, URLSearchParams and urllib write it
//
// Errors, here and of the getters, are invalidArgument: `where` is the parameter's name (empty where there is
// none to name), `what` is wrong with it, `advice` what is allowed. parameterProblem() (http/problem.hpp)
// makes a response of them. Thread: any; a query is not altered once parsed.
#pragma once

#include "shared/base/result.hpp"

#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stipple::server {

inline constexpr std::size_t maxQueryParameters = 64;

class Query {
  public:
    // `text` without the "?". Refused: names given twice, parameters without "=", without a name or without a
    // value, broken percent-encoding, bytes that are no UTF-8, control bytes but for tab and line ends, more
    // than maxQueryParameters. An empty text has no parameters.
    static Result<Query> parse(std::string_view text);

    // Refuses parameters of other names, naming those there are.
    Status allowOnly(std::span<const std::string_view> names) const;
    Status allowOnly(std::initializer_list<std::string_view> names) const {
        return allowOnly(std::span(names.begin(), names.size()));
    }

    // The decoded value; null: not given. Valid as long as the query.
    const std::string* find(std::string_view name) const;
    bool has(std::string_view name) const { return find(name) != nullptr; }

    // The getters answer nothing where the parameter is not given.

    // A finite number in [least, most], in decimal or with an exponent.
    Result<std::optional<double>> number(std::string_view name,
                                         double least = -std::numeric_limits<double>::max(),
                                         double most = std::numeric_limits<double>::max()) const;
    // A whole number in [least, most], digits only.
    Result<std::optional<std::uint64_t>>
    count(std::string_view name, std::uint64_t least = 0,
          std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) const;
    // Finite numbers joined by commas. `form` shows them, "x,y,z": as many as it has names; several forms are
    // joined by "|", "minx,miny,maxx,maxy|minx,miny,minz,maxx,maxy,maxz".
    Result<std::optional<std::vector<double>>> numbers(std::string_view name, std::string_view form) const;
    // Place in `choices`; letters count as written.
    Result<std::optional<std::size_t>> choice(std::string_view name,
                                              std::span<const std::string_view> choices) const;
    Result<std::optional<std::size_t>> choice(std::string_view name,
                                              std::initializer_list<std::string_view> choices) const {
        return choice(name, std::span(choices.begin(), choices.size()));
    }

  private:
    std::vector<std::pair<std::string, std::string>> parameters_; // decoded, in the order given
};

Error parameterError(std::string_view name, std::string what, std::string allowed);

// All of `text` as a finite number: digits with a point and an exponent, "-" before it. No spaces, no "+", no
// "inf", no "nan", no hexadecimals.
std::optional<double> finiteNumber(std::string_view text);

// "a,b,,c" is a, b, nothing and c; an empty text is one empty part.
std::vector<std::string_view> splitAt(std::string_view text, char separator);

// A value as messages show it: in quotation marks, cut to 60 bytes (between characters).
std::string quotedValue(std::string_view text);

} // namespace stipple::server
