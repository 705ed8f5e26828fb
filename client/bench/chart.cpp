#include "client/bench/chart.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace stipple::bench {
namespace {

constexpr double width = 600, height = 380, left = 62, right = 16, top = 34, bottom = 52;
// Okabe and Ito 2008: told apart with any colour vision.
constexpr std::array<const char*, 8> colours{"#0072B2", "#D55E00", "#009E73", "#CC79A7",
                                             "#E69F00", "#56B4E9", "#7A5195", "#666666"};

std::string number(double value, const char* format = "%.4g") {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

bool isDrawn(const Chart& chart, const ChartPoint& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && (!chart.logX || p.x > 0) && (!chart.logY || p.y > 0);
}

// One direction of the chart: values to places.
struct Axis {
    bool logarithmic = false;
    double low = 0, high = 1; // values
    double from = 0, to = 0;  // places
    std::vector<double> ticks;

    Axis(bool isLog, std::vector<double> values, double placeFrom, double placeTo)
        : logarithmic(isLog), from(placeFrom), to(placeTo) {
        auto [least, most] = std::minmax_element(values.begin(), values.end());
        low = logarithmic ? *least : std::min(0.0, *least);
        high = *most;
        if (logarithmic) {
            low /= 1.25;
            high *= 1.25;
        } else {
            high = high > low ? high + 0.06 * (high - low) : low + 1;
        }
        ticks = ticksBetween(low, high, logarithmic);
    }
    double place(double value) const {
        double t = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
        return from + t * (to - from);
    }
};

std::string frame(const Chart& chart, const Axis& x, const Axis& y) {
    std::string svg;
    for (double tick : x.ticks)
        svg += cat("<line class=\"grid\" x1=\"", number(x.place(tick)), "\" x2=\"", number(x.place(tick)),
                   "\" y1=\"", top, "\" y2=\"", height - bottom, "\"/><text x=\"", number(x.place(tick)),
                   "\" y=\"", height - bottom + 16, "\" text-anchor=\"middle\">", number(tick), "</text>\n");
    for (double tick : y.ticks)
        svg +=
            cat("<line class=\"grid\" x1=\"", left, "\" x2=\"", width - right, "\" y1=\"",
                number(y.place(tick)), "\" y2=\"", number(y.place(tick)), "\"/><text x=\"", left - 6,
                "\" y=\"", number(y.place(tick) + 4), "\" text-anchor=\"end\">", number(tick), "</text>\n");
    svg += cat("<text x=\"", (left + width - right) / 2, "\" y=\"", height - 14, "\" text-anchor=\"middle\">",
               escaped(chart.xLabel), "</text>\n<text transform=\"translate(14,", (top + height - bottom) / 2,
               ") rotate(-90)\" text-anchor=\"middle\">", escaped(chart.yLabel), "</text>\n");
    return svg;
}

std::string path(const std::vector<ChartPoint>& points, const Axis& x, const Axis& y) {
    std::string d;
    for (const ChartPoint& p : points)
        d += cat(d.empty() ? "M" : " L", number(x.place(p.x)), " ", number(y.place(p.y)));
    return d;
}

// From each point straight on until the next one takes over: nothing lies between two points.
std::string staircase(const std::vector<ChartPoint>& points, const Axis& x, const Axis& y) {
    std::string d;
    for (const ChartPoint& p : points)
        d += d.empty() ? cat("M", number(x.place(p.x)), " ", number(y.place(p.y)))
                       : cat(" H", number(x.place(p.x)), " V", number(y.place(p.y)));
    return d;
}

std::string drawn(const ChartSeries& series, const char* colour, const Axis& x, const Axis& y) {
    std::string svg = cat("<path d=\"", path(series.points, x, y), "\" fill=\"none\" stroke=\"", colour,
                          "\" stroke-width=\"1.6\"/>\n");
    for (const ChartPoint& p : series.points) {
        std::string px = number(x.place(p.x)), py = number(y.place(p.y));
        svg += cat("<circle cx=\"", px, "\" cy=\"", py, "\" r=\"3\" fill=\"", colour, "\"><title>",
                   escaped(series.name), " ", escaped(p.label), ": ", number(p.x), ", ", number(p.y),
                   "</title></circle>");
        if (!p.label.empty())
            svg += cat("<text class=\"label\" x=\"", number(x.place(p.x) + 5), "\" y=\"",
                       number(y.place(p.y) - 5), "\">", escaped(p.label), "</text>");
        svg += "\n";
    }
    return svg;
}

std::string legend(const std::vector<ChartSeries>& series) {
    std::string svg;
    double y = top + 12;
    for (std::size_t i = 0; i < series.size(); ++i, y += 15)
        svg += cat("<circle cx=\"", width - right - 120, "\" cy=\"", y - 4, "\" r=\"4\" fill=\"",
                   colours[i % colours.size()], "\"/><text x=\"", width - right - 112, "\" y=\"", y, "\">",
                   escaped(series[i].name), "</text>\n");
    return svg;
}

} // namespace

std::string escaped(std::string_view text) {
    std::string result;
    for (char c : text)
        switch (c) {
        case '&':
            result += "&amp;";
            break;
        case '<':
            result += "&lt;";
            break;
        case '>':
            result += "&gt;";
            break;
        case '"':
            result += "&quot;";
            break;
        default:
            result += c;
        }
    return result;
}

std::vector<double> ticksBetween(double low, double high, bool logarithmic) {
    std::vector<double> ticks;
    if (!logarithmic) {
        double rough = (high - low) / 6, power = std::pow(10, std::floor(std::log10(rough)));
        double step = rough / power > 5   ? 10 * power
                      : rough / power > 2 ? 5 * power
                      : rough / power > 1 ? 2 * power
                                          : power;
        for (double i = std::ceil(low / step); i * step <= high; ++i)
            ticks.push_back(i * step);
        return ticks;
    }
    bool wide = std::log10(high / low) > 2.5;
    for (double power = std::floor(std::log10(low)); power <= std::log10(high); ++power)
        for (double digit : {1.0, 2.0, 5.0}) {
            double tick = digit * std::pow(10, power);
            if (tick >= low && tick <= high && (!wide || digit == 1))
                ticks.push_back(tick);
        }
    return ticks;
}

std::vector<ChartPoint> paretoPoints(const std::vector<ChartSeries>& series) {
    std::vector<ChartPoint> all, front;
    for (const ChartSeries& one : series)
        all.insert(all.end(), one.points.begin(), one.points.end());
    std::sort(all.begin(), all.end(),
              [](const ChartPoint& a, const ChartPoint& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
    for (const ChartPoint& p : all)
        if (front.empty() || p.y < front.back().y)
            front.push_back(p);
    return front;
}

std::string svgOf(const Chart& chart) {
    Chart shown = chart;
    std::vector<double> xs, ys;
    for (ChartSeries& series : shown.series) {
        std::erase_if(series.points, [&](const ChartPoint& p) { return !isDrawn(chart, p); });
        for (const ChartPoint& p : series.points) {
            xs.push_back(p.x);
            ys.push_back(p.y);
        }
    }
    std::string svg = cat("<svg viewBox=\"0 0 ", width, " ", height, "\" width=\"", width, "\" height=\"",
                          height, "\" role=\"img\">\n<text class=\"title\" x=\"", left, "\" y=\"18\">",
                          escaped(chart.title), "</text>\n");
    if (xs.empty())
        return svg + "<text x=\"80\" y=\"180\">nothing to show</text>\n</svg>\n";
    Axis x(chart.logX, xs, left, width - right), y(chart.logY, ys, height - bottom, top);
    svg += frame(chart, x, y);
    if (chart.paretoLine)
        svg += cat("<path class=\"pareto\" d=\"", staircase(paretoPoints(shown.series), x, y), "\"/>\n");
    for (std::size_t i = 0; i < shown.series.size(); ++i)
        svg += drawn(shown.series[i], colours[i % colours.size()], x, y);
    return svg + legend(shown.series) + "</svg>\n";
}

} // namespace stipple::bench
