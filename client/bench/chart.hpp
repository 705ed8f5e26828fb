// Line charts as SVG text, for reports.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stipple::bench {

struct ChartPoint {
    double x = 0, y = 0;
    std::string label; // written beside the point; may be empty
};

struct ChartSeries {
    std::string name;
    std::vector<ChartPoint> points; // joined in this order
};

struct Chart {
    std::string title, xLabel, yLabel;
    bool logX = false, logY = false; // values <= 0 are left out
    // Draw the line of the points, of all series, that no other point beats in both directions (less is
    // better).
    bool paretoLine = false;
    std::vector<ChartSeries> series;
};

// An <svg> element, 600 × 380. A chart without points says so.
std::string svgOf(const Chart& chart);

// The points that no other beats: none has both a smaller or equal x and a smaller or equal y (and differs).
// By x.
std::vector<ChartPoint> paretoPoints(const std::vector<ChartSeries>& series);

// Places for the marks of an axis from `low` to `high`: multiples of 1, 2 or 5 times a power of ten; on a
// logarithmic axis 1, 2 and 5 times powers of ten, or the powers alone.
std::vector<double> ticksBetween(double low, double high, bool logarithmic);

// &, <, > and quotes as entities.
std::string escaped(std::string_view text);

} // namespace stipple::bench
