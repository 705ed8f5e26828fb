// Numbers as text, exactly: coordinates and scaled values as the decimals they are, floating point as the
// shortest text that reads back to the same value.
#pragma once

#include "shared/sinks/shortest_number.hpp"

#include <cstdint>
#include <string>

namespace stipple {

// The numbers offset + scale × n for integers n, where scale and offset are taken as the decimals that people
// write for them (the shortest ones that read back to these doubles: 0.01, not 0.01000000000000000021). Then
// every such number is a decimal of a fixed number of places, and is written with all of them: who reads them
// gets n back. Where that takes more than 128-bit integers, numbers are shortest doubles instead.
class DecimalScale {
  public:
    // `least` and `greatest`: between them n is expected to lie; there it is fastest.
    DecimalScale(double scale, double offset, std::int64_t least, std::int64_t greatest);

    bool exact() const { return places_ >= 0; }
    int places() const { return places_; }
    void append(std::string& text, std::int64_t n) const;

  private:
    double scale_, offset_;
    std::int64_t least_, greatest_;
    int places_ = -1; // decimal places; -1: not exact
    // The number × 10^places is factor × n + summand; narrow_: it fits 64 bits for the n expected.
    __extension__ __int128 factor_ = 0, summand_ = 0;
    bool narrow_ = false;
};

void appendInteger(std::string& text, std::int64_t value);
void appendInteger(std::string& text, std::uint64_t value);

} // namespace stipple
