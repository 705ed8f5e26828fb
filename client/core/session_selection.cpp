#include "client/core/session_selection.hpp"

#include "client/core/cloud_needs.hpp"
#include "client/core/exact_nodes.hpp"

namespace stipple {

namespace {

bool isShown(const CloudLoader& cloud) {
    return cloud.ready() && cloud.state.visible;
}

SelectionInput inputOf(const SessionView& view, const SessionLimits& limits, double coarser) {
    SelectionInput input;
    input.view = view.transform;
    input.height = view.height;
    bool isContinuous = view.style.detail.mode == DetailMode::continuous;
    input.pointBudget = limits.pointBudget;
    if (!isContinuous)
        input.pointBudget =
            static_cast<std::uint64_t>(static_cast<double>(limits.pointBudget) / (coarser * coarser));
    input.byteBudget = limits.cacheBytes;
    input.minNodePixels = limits.minNodePixels;
    input.weights = limits.weights;
    input.detailPixels = isContinuous ? view.style.detail.spacingPixels * coarser : 0;
    input.clips = view.clips.hidesPoints() ? &view.clips : nullptr;
    input.skips = limits.skips;
    input.wholeNodes = !limits.techniques.prefixes;
    input.beginningsFirst = !limits.techniques.byValue;
    return input;
}

} // namespace

void selectNodes(SessionView& view, CloudMap& clouds, const SessionLimits& limits, double coarser) {
    std::vector<SelectionCloud> inputs;
    view.clouds.clear();
    std::uint64_t hiddenNodes = 0; // of clouds of which the style hides every point
    for (auto& [id, cloud] : clouds) {
        if (!isShown(cloud))
            continue;
        if (limits.skips.hidden && hidesAll(view.style, *cloud.opened.metadata)) {
            hiddenNodes += cloud.hierarchy.size();
            continue;
        }
        view.clouds.push_back(id);
        inputs.push_back({&cloud.hierarchy, cloud.residency, bytesPerPoint(cloud, view.style)});
    }
    SelectionInput input = inputOf(view, limits, coarser);
    input.clouds = inputs;
    view.selection = select(input);
    view.selection.counters.coarserForTime = coarser;
    view.selection.counters.nodesHidden += hiddenNodes;
    view.exact = exactNodes(view, clouds);
}

BoxD shownBounds(const CloudMap& clouds) {
    BoxD box;
    for (const auto& [id, cloud] : clouds)
        if (cloud.state.visible && cloud.state.stage != CloudStage::failed && !cloud.place().empty())
            box.extend(cloud.place());
    return box;
}

} // namespace stipple
