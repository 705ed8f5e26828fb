// The results as JSON and CSV.
#include "client/bench/report.hpp"
#include "client/core/json.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace stipple::bench {
namespace {

using nlohmann::json;

json toJson(const Spread& spread) {
    return {{"median", spread.median}, {"least", spread.least}, {"most", spread.most}};
}

json toJson(const std::optional<double>& value) {
    return value ? json(*value) : json(nullptr);
}

json toJson(const FrameResult& frame) {
    return {{"counters", stipple::toJson(frame.counters)},
            {"bytesFetched", frame.bytesFetched},
            {"requests", frame.requests},
            {"loadSeconds", frame.loadSeconds},
            {"selectSeconds", toJson(frame.select)},
            {"drawSeconds", toJson(frame.draw)},
            {"bytesReloaded", frame.bytesReloaded},
            {"meanError", frame.pixels.mean},
            {"rms", frame.pixels.rms},
            {"largest", frame.pixels.largest},
            {"differingPixels", frame.pixels.differing},
            {"ssim", frame.ssim},
            {"flip", frame.flip},
            {"wrongDepthShare", frame.depth.wrongShare},
            {"holeShare", frame.depth.holeShare},
            {"extraShare", frame.depth.extraShare},
            {"pixelsCovered", frame.depth.picturePixels},
            {"referencePixelsCovered", frame.depth.referencePixels},
            {"change", toJson(frame.change)},
            {"referenceChange", toJson(frame.referenceChange)}};
}

json toJson(const Summary& s) {
    return {{"cloud", s.cloud},
            {"mode", s.mode},
            {"renderer", s.renderer},
            {"budget", s.budget},
            {"frames", s.frames},
            {"drawSeconds", s.drawSeconds},
            {"selectSeconds", s.selectSeconds},
            {"pointsConsidered", s.pointsConsidered},
            {"pointsSelected", s.pointsSelected},
            {"pointsDrawn", s.pointsDrawn},
            {"nodesDrawn", s.nodesDrawn},
            {"pixelsCovered", s.pixelsCovered},
            {"bytesFetched", s.bytesFetched},
            {"meanError", s.meanError},
            {"rms", s.rms},
            {"largest", s.largest},
            {"ssim", s.ssim},
            {"flip", s.flip},
            {"wrongDepthShare", s.wrongDepth},
            {"holeShare", s.holes},
            {"extraShare", s.extra},
            {"popping", s.popping}};
}

// null where the other mode has nothing to divide by.
json quotient(double value) {
    return std::isfinite(value) ? json(value) : json(nullptr);
}

json toJson(const Comparison& c) {
    return {{"cloud", c.cloud},
            {"mode", c.mode},
            {"against", c.against},
            {"group", c.group},
            {"budget", c.budget},
            {"drawSeconds", quotient(c.drawSeconds)},
            {"selectSeconds", quotient(c.selectSeconds)},
            {"nodesDrawn", quotient(c.nodesDrawn)},
            {"pointsDrawn", quotient(c.pointsDrawn)},
            {"bytesFetched", quotient(c.bytesFetched)},
            {"meanError", c.meanError},
            {"ssim", c.ssim},
            {"flip", c.flip},
            {"holeShare", c.holes}};
}

template <class T>
json listOf(const std::vector<T>& items) {
    json list = json::array();
    for (const T& item : items)
        list.push_back(toJson(item));
    return list;
}

// Quoted where it must be (RFC 4180).
std::string csvField(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

} // namespace

json toJson(const BenchResult& result) {
    json clouds = json::array(), runs = json::array();
    for (const CloudResult& cloud : result.clouds)
        clouds.push_back({{"name", cloud.name},
                          {"points", cloud.points},
                          {"pointHash", cloud.pointHash},
                          {"bounds", stipple::toJson(cloud.bounds)},
                          {"paths", listOf(cloud.paths)},
                          {"limitations", cloud.limitations}});
    for (const Run& run : result.runs)
        runs.push_back({{"cloud", run.cloud},
                        {"path", run.path},
                        {"mode", run.mode},
                        {"budget", run.budget},
                        {"renderer", run.renderer},
                        {"frames", listOf(run.frames)}});
    return {{"machine", toJson(result.machine)},
            {"size", {result.width, result.height}},
            {"repeats", result.repeats},
            {"samples", result.samples},
            {"threads", result.threads},
            {"modes", listOf(result.modes)},
            {"clouds", clouds},
            {"summaries", listOf(summarise(result.runs))},
            {"comparisons", listOf(compare(summarise(result.runs), result.modes))},
            {"runs", runs}};
}

std::string csvOf(const BenchResult& result) {
    std::string text =
        "cloud,path,mode,budget,renderer,frame,drawSeconds,drawSecondsLeast,drawSecondsMost,selectSeconds,"
        "loadSeconds,pointsConsidered,pointsSelected,pointsDrawn,nodesVisited,nodesDrawn,pixelsCovered,"
        "bytesFetched,requests,bytesReloaded,meanError,rms,largest,differingPixels,ssim,flip,"
        "wrongDepthShare,holeShare,extraShare,change,referenceChange\n";
    auto optional = [](const std::optional<double>& value) { return value ? cat(*value) : std::string(); };
    for (const Run& run : result.runs)
        for (std::size_t i = 0; i < run.frames.size(); ++i) {
            const FrameResult& f = run.frames[i];
            const FrameCounters& c = f.counters;
            text += cat(csvField(run.cloud), ",", csvField(run.path), ",", csvField(run.mode), ",",
                        run.budget, ",", csvField(run.renderer), ",", i, ",", f.draw.median, ",",
                        f.draw.least, ",", f.draw.most, ",", f.select.median, ",", f.loadSeconds, ",",
                        c.pointsConsidered, ",", c.pointsSelected, ",", c.pointsDrawn, ",", c.nodesVisited,
                        ",", c.nodesDrawn, ",", f.depth.picturePixels, ",");
            text += cat(f.bytesFetched, ",", f.requests, ",", f.bytesReloaded, ",", f.pixels.mean, ",",
                        f.pixels.rms, ",", f.pixels.largest, ",", f.pixels.differing, ",", f.ssim, ",",
                        f.flip, ",", f.depth.wrongShare, ",", f.depth.holeShare, ",", f.depth.extraShare, ",",
                        optional(f.change), ",", optional(f.referenceChange), "\n");
        }
    return text;
}

} // namespace stipple::bench
