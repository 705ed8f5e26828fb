#include "client/core/counted_view.hpp"

#include <algorithm>

namespace stipple {

CountedView countedViewOf(const SessionView& view, SessionLoading& loading) {
    CountedView counted;
    counted.view = view.transform;
    counted.width = view.width;
    counted.height = view.height;
    counted.style = view.style;
    counted.clips = view.clips;
    for (const SelectedNode& selected : view.selection.nodes) {
        const CachedNode* cached = loading.cache().find(view.cacheKey(selected));
        if (selected.drawPoints == 0 || !cached || !cached->node)
            continue;
        const CloudLoader& cloud = view.cloudOf(loading.clouds(), selected);
        const HierarchyNode& known = cloud.hierarchy.node(selected.node);
        const auto& metadata = cloud.opened.metadata;
        bool isMean = metadata->innerColour == InnerColour::mean && cloud.lacksExact(selected.node, *cached);
        counted.nodes.push_back({cached->node, cached->columns(),
                                 std::min(selected.drawPoints, cached->node->pointCount),
                                 cloud.hasWatched(selected.node, *cached), isMean,
                                 metadata->rootCube.nodeMin(known.entry.key), known.geometry.box, metadata});
    }
    return counted;
}

} // namespace stipple
