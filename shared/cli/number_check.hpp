// Checks of options that take a number: CLI11 validators whose refusals say what was given and what would do.
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>

namespace stipple::cli {

// More than any cloud has.
inline constexpr std::int64_t mostPoints = 1'000'000'000'000;

// Whole numbers from `least` to `most`, written in decimal digits.
CLI::Validator wholeNumber(std::int64_t least, std::int64_t most);
// Numbers from `least` to `most`; neither NaN nor infinity is one.
CLI::Validator number(double least, double most);
// Finite numbers greater than `limit`.
CLI::Validator numberAbove(double limit);
// Bytes with a unit (K, M, G, T: powers of 1024; "2G", "1.5G", "512MB"), which become a number of bytes.
CLI::Validator memorySize(std::uint64_t leastBytes, std::uint64_t mostBytes);

} // namespace stipple::cli
