// The results as one page.
#include "client/bench/chart.hpp"
#include "client/bench/report.hpp"
#include "client/headless/png.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace stipple::bench {
namespace {

constexpr const char* head = R"html(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Stipple: time against error</title>
<meta name="viewport" content="width=device-width">
<style>
:root { color-scheme: light dark; --line: #8884; --soft: #888; }
body { font: 15px/1.5 system-ui, sans-serif; margin: 2em auto; max-width: 1240px; padding: 0 1em; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 2px 9px; text-align: right; border-bottom: 1px solid var(--line); white-space: nowrap; }
th:first-child, td:first-child, td.text, th.text { text-align: left; }
.scroll { overflow-x: auto; }
.charts, .pictures { display: flex; flex-wrap: wrap; gap: 12px; }
figure { margin: 0 0 1em; } figcaption { font-size: 13px; color: var(--soft); }
.pictures img { width: 290px; height: auto; image-rendering: auto; display: block; }
svg { max-width: 100%; height: auto; font: 11px system-ui, sans-serif; }
svg text { fill: currentColor; } svg .title { font-size: 13px; font-weight: 600; }
svg .label { fill: var(--soft); font-size: 10px; } svg .grid { stroke: var(--line); }
svg .pareto { fill: none; stroke: currentColor; stroke-width: 6; opacity: .14; stroke-linejoin: round; }
</style></head><body>
<h1>Stipple: time against error</h1>
)html";

constexpr const char* explanation =
    R"html(<p>Every picture is compared with its <em>reference</em>: all points of the cloud, in double
precision, in the same style. <b>Mean error</b> is the mean over pixels and channels of the absolute difference (UnityPIC, eq. 6), in per
cent of 255 levels; <b>SSIM</b> (Wang et al. 2004) is 1 for equal pictures, <b>FLIP</b> (Andersson et al. 2020) 0. <b>Wrong depth</b>: pixels
that both cover, at distances more than 1 % apart; <b>holes</b>: pixels that the reference covers and the picture leaves empty;
<b>extra</b>: the reverse. <b>Popping</b>: how much more, or less, a picture differs from the one before it than their references do, in
levels. Times are medians of warm frames: everything a frame needs has been loaded in an earlier pass. <i>Draw</i> is from the frame plan to the
picture in memory, <i>select</i> one update of the session after the camera moved. Bytes are those of the first, cold pass, per frame.</p>
)html";

std::string number(double value, const char* format) {
    char text[40];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

// 1500000 → "1.5 M".
std::string millions(double points) {
    return number(points / 1e6, "%.3g") + " M";
}

std::string base64(ByteSpan bytes) {
    constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t word = 0;
        for (std::size_t k = 0; k < 3; ++k)
            word = word << 8 | (k < count ? bytes[i + k] : 0u);
        for (std::size_t k = 0; k < 4; ++k)
            text += k <= count ? digits[word >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

std::string machineTable(const BenchResult& result) {
    const Machine& m = result.machine;
    auto row = [](const char* name, const std::string& value) {
        return cat("<tr><td>", name, "</td><td class=\"text\">", escaped(value), "</td></tr>\n");
    };
    std::string html = "<table>\n";
    html +=
        row("processor", cat(m.processor, ", ", m.cores, " cores, ", number(m.memoryGiB, "%.1f"), " GiB"));
    html += row("system", cat(m.system, ", compiler ", m.compiler));
    html += row("when", cat(m.time, ", load average before it ", number(m.loadBefore, "%.2f"),
                            m.loadBefore > 0.5 ? " (busy: times are indications)" : ""));
    html += row("pictures", cat(result.width, " × ", result.height, " pixels; references with ",
                                result.samples, " × ", result.samples, " samples a pixel"));
    html += row("repeats", cat(result.repeats, " warm passes along each path; renderer threads: ",
                               result.threads > 0 ? cat(result.threads) : "one per core"));
    return html + "</table>\n";
}

std::string summaryTable(const std::vector<Summary>& summaries) {
    std::string html =
        "<div class=\"scroll\"><table>\n<tr><th>mode</th><th>budget</th><th>draw ms</th><th>select "
        "ms</th><th>points "
        "considered</th><th>selected</th><th>drawn</th><th>nodes</th><th>pixels covered</th><th>MB "
        "fetched</th><th>mean error "
        "%</th><th>RMS</th><th>SSIM</th><th>FLIP</th><th>wrong depth %</th><th>holes %</th><th>extra "
        "%</th><th>popping</th></tr>\n";
    for (const Summary& s : summaries) {
        html += cat("<tr><td>", escaped(s.mode), "</td><td>", millions(double(s.budget)), "</td>");
        for (const std::string& cell :
             {number(s.drawSeconds * 1e3, "%.2f"), number(s.selectSeconds * 1e3, "%.3f"),
              millions(s.pointsConsidered), millions(s.pointsSelected), millions(s.pointsDrawn),
              number(s.nodesDrawn, "%.0f"), number(s.pixelsCovered, "%.0f"),
              number(s.bytesFetched / 1e6, "%.2f"), number(s.meanError / 2.55, "%.3f"), number(s.rms, "%.2f"),
              number(s.ssim, "%.4f"), number(s.flip, "%.4f"), number(s.wrongDepth * 100, "%.2f"),
              number(s.holes * 100, "%.2f"), number(s.extra * 100, "%.2f"), number(s.popping, "%.3f")})
            html += cat("<td>", cell, "</td>");
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

// One series a mode over its budgets; modes with one budget are single points.
Chart summaryChart(const std::vector<Summary>& summaries, double (*x)(const Summary&),
                   double (*y)(const Summary&)) {
    Chart chart;
    for (const Summary& s : summaries) {
        if (chart.series.empty() || chart.series.back().name != s.mode)
            chart.series.push_back({s.mode, {}});
        chart.series.back().points.push_back({x(s), y(s), millions(double(s.budget))});
    }
    return chart;
}

std::string charts(const std::vector<Summary>& summaries) {
    auto time = [](const Summary& s) { return s.drawSeconds * 1e3; };
    auto drawn = [](const Summary& s) { return s.pointsDrawn / 1e6; };
    auto error = [](const Summary& s) { return s.meanError / 2.55; };
    auto flip = [](const Summary& s) { return s.flip; };
    std::string html = "<div class=\"charts\">\n";
    auto add = [&](Chart chart, const char* title, const char* xLabel, const char* yLabel, bool logY,
                   bool pareto) {
        chart.title = title;
        chart.xLabel = xLabel;
        chart.yLabel = yLabel;
        chart.logX = true;
        chart.logY = logY;
        chart.paretoLine = pareto;
        html += svgOf(chart);
    };
    add(summaryChart(summaries, time, error), "Time against mean error", "draw, ms", "mean error, %", true,
        true);
    add(summaryChart(summaries, time, flip), "Time against FLIP", "draw, ms", "FLIP", true, true);
    add(summaryChart(summaries, drawn, error), "Points against mean error", "points drawn, millions",
        "mean error, %", true, false);
    add(summaryChart(summaries, drawn, time), "Points against time", "points drawn, millions", "draw, ms",
        true, false);
    return html + "</div>\n";
}

// The modes of each group, with those that they are compared with.
std::string groupCharts(const std::vector<Summary>& summaries, const std::vector<Mode>& modes) {
    std::vector<std::string> groups;
    for (const Mode& mode : modes)
        if (!mode.group.empty() && std::find(groups.begin(), groups.end(), mode.group) == groups.end())
            groups.push_back(mode.group);
    std::string html = "<div class=\"charts\">\n";
    for (const std::string& group : groups) {
        auto belongs = [&](const std::string& name) {
            return std::any_of(modes.begin(), modes.end(), [&](const Mode& mode) {
                return mode.group == group && (mode.name == name || mode.against == name);
            });
        };
        std::vector<Summary> members;
        std::copy_if(summaries.begin(), summaries.end(), std::back_inserter(members),
                     [&](const Summary& s) { return belongs(s.mode); });
        Chart chart = summaryChart(
            members, [](const Summary& s) { return s.drawSeconds * 1e3; },
            [](const Summary& s) { return s.meanError / 2.55; });
        chart.title = cat("Time against mean error: ", group);
        chart.xLabel = "draw, ms";
        chart.yLabel = "mean error, %";
        chart.logX = chart.logY = true;
        html += svgOf(chart);
    }
    return html + "</div>\n";
}

std::string comparisonTable(const std::vector<Comparison>& comparisons) {
    if (comparisons.empty())
        return "";
    std::string html =
        "<h3>One mode against another</h3>\n<p>Of the first, as part of the second's: 1 is the same. "
        "Errors: the first's less the second's.</p>\n"
        "<div class=\"scroll\"><table>\n<tr><th>mode</th><th class=\"text\">against</th><th>budget</th>"
        "<th>draw time</th><th>select time</th><th>nodes drawn</th><th>points drawn</th><th>bytes</th>"
        "<th>mean error, %</th><th>SSIM</th><th>holes, %</th></tr>\n";
    for (const Comparison& c : comparisons) {
        html += cat("<tr><td>", escaped(c.mode), "</td><td class=\"text\">", escaped(c.against), "</td><td>",
                    millions(double(c.budget)), "</td>");
        for (const std::string& cell :
             {number(c.drawSeconds, "%.3f"), number(c.selectSeconds, "%.3f"), number(c.nodesDrawn, "%.3f"),
              number(c.pointsDrawn, "%.3f"), number(c.bytesFetched, "%.3f"),
              number(c.meanError / 2.55, "%+.4f"), number(c.ssim, "%+.5f"), number(c.holes * 100, "%+.3f")})
            html += cat("<td>", cell, "</td>");
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

// Of each path a chart: error along the frames, a series for each mode at its last budget.
std::string pathCharts(const BenchResult& result, const CloudResult& cloud) {
    std::string html = "<div class=\"charts\">\n";
    for (const CameraPath& path : cloud.paths) {
        Chart chart;
        chart.title = cat("Along ", path.name);
        chart.xLabel = "frame";
        chart.yLabel = "mean error, %";
        for (const Run& run : result.runs) {
            if (run.cloud != cloud.name || run.path != path.name)
                continue;
            std::string name = cat(run.mode, " ", millions(double(run.budget)));
            bool newer = !chart.series.empty() && chart.series.back().name.rfind(run.mode + " ", 0) == 0;
            if (newer)
                chart.series.pop_back();
            chart.series.push_back({name, {}});
            for (std::size_t i = 0; i < run.frames.size(); ++i)
                chart.series.back().points.push_back({double(i), run.frames[i].pixels.mean / 2.55, ""});
        }
        html += svgOf(chart);
    }
    return html + "</div>\n";
}

Result<std::string> pictureRow(const SamplePictures& p) {
    std::string html =
        cat("<h4>", escaped(p.mode), ", ", millions(double(p.budget)), "</h4>\n<div class=\"pictures\">\n");
    const std::pair<const char*, const Image*> all[] = {{"picture", &p.picture},
                                                        {"reference", &p.reference},
                                                        {"difference, twice, around grey", &p.difference},
                                                        {"FLIP, black 0 to yellow 1", &p.flip}};
    for (auto [caption, image] : all) {
        STIPPLE_TRY(png, headless::encodePng(*image));
        html += cat("<figure><img alt=\"", caption, "\" src=\"data:image/png;base64,", base64(png),
                    "\"><figcaption>", caption, "</figcaption></figure>\n");
    }
    return html + "</div>\n";
}

Result<std::string> cloudSection(const BenchResult& result, const CloudResult& cloud,
                                 const std::vector<Summary>& all) {
    std::vector<Summary> summaries;
    std::copy_if(all.begin(), all.end(), std::back_inserter(summaries),
                 [&](const Summary& s) { return s.cloud == cloud.name; });
    std::string html =
        cat("<h2>", escaped(cloud.name), "</h2>\n<p>", cloud.points, " points; ", cloud.paths.size(),
            " paths. Means over all their frames; times are medians.</p>\n");
    for (const std::string& sentence : cloud.limitations)
        html += cat("<p>", escaped(sentence), ".</p>\n");
    html += charts(summaries) + groupCharts(summaries, result.modes) +
            comparisonTable(compare(summaries, result.modes)) + summaryTable(summaries) +
            pathCharts(result, cloud);
    html += "<h3>Pictures</h3>\n";
    for (const SamplePictures& p : result.pictures) {
        if (p.cloud != cloud.name)
            continue;
        STIPPLE_TRY(row, pictureRow(p));
        html += row;
    }
    return html;
}

std::string modeTable(const BenchResult& result) {
    std::string html = "<h2>Modes</h2>\n<table>\n";
    for (const Mode& mode : result.modes)
        html += cat("<tr><td>", escaped(mode.name), "</td><td class=\"text\">", escaped(mode.about),
                    "</td></tr>\n");
    return html + "</table>\n";
}

} // namespace

Result<std::string> htmlOf(const BenchResult& result) {
    std::string html = head + machineTable(result) + explanation;
    std::vector<Summary> summaries = summarise(result.runs);
    for (const CloudResult& cloud : result.clouds) {
        STIPPLE_TRY(section, cloudSection(result, cloud, summaries));
        html += section;
    }
    return html + modeTable(result) + "</body></html>\n";
}

} // namespace stipple::bench
