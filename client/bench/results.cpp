#include "client/bench/results.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace stipple::bench {
namespace {

using Frames = std::vector<const FrameResult*>;

std::vector<double> valuesOf(const Frames& frames, const std::function<double(const FrameResult&)>& value) {
    std::vector<double> values;
    for (const FrameResult* frame : frames)
        values.push_back(value(*frame));
    return values;
}

void fill(Summary& summary, const Frames& frames) {
    auto mean = [&](auto value) { return meanOf(valuesOf(frames, value)); };
    auto middle = [&](auto value) { return median(valuesOf(frames, value)); };
    using F = FrameResult;
    summary.frames = frames.size();
    summary.drawSeconds = middle([](const F& f) { return f.draw.median; });
    summary.selectSeconds = middle([](const F& f) { return f.select.median; });
    summary.pointsConsidered = mean([](const F& f) { return double(f.counters.pointsConsidered); });
    summary.pointsSelected = mean([](const F& f) { return double(f.counters.pointsSelected); });
    summary.pointsDrawn = mean([](const F& f) { return double(f.counters.pointsDrawn); });
    summary.nodesDrawn = mean([](const F& f) { return double(f.counters.nodesDrawn); });
    summary.pixelsCovered = mean([](const F& f) { return double(f.depth.picturePixels); });
    summary.bytesFetched = mean([](const F& f) { return double(f.bytesFetched); });
    summary.meanError = mean([](const F& f) { return f.pixels.mean; });
    summary.rms = mean([](const F& f) { return f.pixels.rms; });
    summary.ssim = mean([](const F& f) { return f.ssim; });
    summary.flip = mean([](const F& f) { return f.flip; });
    summary.wrongDepth = mean([](const F& f) { return f.depth.wrongShare; });
    summary.holes = mean([](const F& f) { return f.depth.holeShare; });
    summary.extra = mean([](const F& f) { return f.depth.extraShare; });
    std::vector<double> popping;
    for (const FrameResult* frame : frames) {
        summary.largest = std::max(summary.largest, double(frame->pixels.largest));
        if (frame->change && frame->referenceChange)
            popping.push_back(std::abs(*frame->change - *frame->referenceChange));
    }
    summary.popping = meanOf(popping);
}

} // namespace

std::vector<Summary> summarise(const std::vector<Run>& runs) {
    std::vector<Summary> summaries;
    std::vector<Frames> frames;
    for (const Run& run : runs) {
        auto same = [&](const Summary& s) {
            return s.cloud == run.cloud && s.mode == run.mode && s.budget == run.budget;
        };
        auto at = static_cast<std::size_t>(std::find_if(summaries.begin(), summaries.end(), same) -
                                           summaries.begin());
        if (at == summaries.size()) {
            Summary summary;
            summary.cloud = run.cloud;
            summary.mode = run.mode;
            summary.renderer = run.renderer;
            summary.budget = run.budget;
            summaries.push_back(summary);
            frames.emplace_back();
        }
        for (const FrameResult& frame : run.frames)
            frames[at].push_back(&frame);
    }
    for (std::size_t i = 0; i < summaries.size(); ++i)
        fill(summaries[i], frames[i]);
    return summaries;
}

std::vector<Comparison> compare(const std::vector<Summary>& summaries, const std::vector<Mode>& modes) {
    auto find = [&](const Summary& like, const std::string& mode) {
        return std::find_if(summaries.begin(), summaries.end(), [&](const Summary& s) {
            return s.cloud == like.cloud && s.mode == mode && s.budget == like.budget;
        });
    };
    std::vector<Comparison> found;
    for (const Summary& s : summaries) {
        auto mode = std::find_if(modes.begin(), modes.end(), [&](const Mode& m) { return m.name == s.mode; });
        if (mode == modes.end() || mode->against.empty())
            continue;
        auto other = find(s, mode->against);
        if (other == summaries.end())
            continue;
        found.push_back({s.cloud, s.mode, mode->against, mode->group, s.budget,
                         s.drawSeconds / other->drawSeconds, s.selectSeconds / other->selectSeconds,
                         s.nodesDrawn / other->nodesDrawn, s.pointsDrawn / other->pointsDrawn,
                         s.bytesFetched / other->bytesFetched, s.meanError - other->meanError,
                         s.ssim - other->ssim, s.flip - other->flip, s.holes - other->holes});
    }
    return found;
}

} // namespace stipple::bench
