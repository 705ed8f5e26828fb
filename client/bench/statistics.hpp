// Numbers that are measured again and again.
#pragma once

#include <algorithm>
#include <vector>

namespace stipple::bench {

// Of an even number of values, the mean of the two in the middle; 0 of none.
inline double median(std::vector<double> values) {
    if (values.empty())
        return 0;
    std::sort(values.begin(), values.end());
    std::size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

inline double meanOf(const std::vector<double>& values) {
    double sum = 0;
    for (double value : values)
        sum += value;
    return values.empty() ? 0 : sum / static_cast<double>(values.size());
}

// Median and range of repeated measurements.
struct Spread {
    double median = 0, least = 0, most = 0;
};
inline Spread spreadOf(const std::vector<double>& values) {
    if (values.empty())
        return {};
    auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {median(values), *least, *most};
}

} // namespace stipple::bench
