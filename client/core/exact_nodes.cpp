#include "client/core/exact_nodes.hpp"

#include "client/core/frustum.hpp"

#include <algorithm>

namespace stipple {

std::set<std::pair<std::uint32_t, std::uint32_t>> exactNodes(const SessionView& view,
                                                             const CloudMap& clouds) {
    std::set<std::pair<std::uint32_t, std::uint32_t>> whole, exact;
    for (const SelectedNode& selected : view.selection.nodes) {
        const CloudLoader& cloud = view.cloudOf(clouds, selected);
        if (cloud.needs.exactBlock >= 0 &&
            selected.drawPoints == cloud.hierarchy.node(selected.node).entry.pointCount)
            whole.emplace(selected.cloud, selected.node);
    }
    if (whole.empty())
        return exact;
    Frustum frustum(view.transform);
    for (const auto& [cloudIndex, node] : whole) {
        const CloudLoader& cloud = clouds.at(view.clouds[cloudIndex]);
        const HierarchyNode& known = cloud.hierarchy.node(node);
        auto exactBlock = static_cast<std::size_t>(cloud.needs.exactBlock);
        if (known.childrenState != ChildrenState::known || known.entry.attributeBytes[exactBlock] == 0)
            continue;
        bool coarse =
            std::any_of(known.children.begin(), known.children.end(), [&, &index = cloudIndex](int child) {
                if (child < 0 || whole.contains({index, static_cast<std::uint32_t>(child)}))
                    return false;
                const BoxD& box = cloud.hierarchy.node(static_cast<std::size_t>(child)).geometry.box;
                return frustum.intersects(box) && !view.clips.clipVerdict(box).hidden;
            });
        if (!coarse)
            exact.emplace(cloudIndex, node);
    }
    return exact;
}

} // namespace stipple
