// The shortest text that reads back as the same floating-point number, as std::to_chars() writes it; for
// standard libraries that can't write those yet, too.
#pragma once

#include <string>

namespace stipple {

// "0.1", "1e+22", "-nan"
void appendShortest(std::string& text, double value);
void appendShortest(std::string& text, float value);
// "1e-01", "1e+22", "inf"
std::string shortestScientific(double value);

// The same by printf and strtod alone. Where the numbers around a power of two lie unevenly it may have a
// digit more than need be; it reads back equal all the same.
namespace portable {
void appendShortest(std::string& text, double value);
void appendShortest(std::string& text, float value);
std::string shortestScientific(double value);
} // namespace portable

} // namespace stipple
