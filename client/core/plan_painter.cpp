#include "client/core/plan_painter.hpp"

namespace stipple {

namespace {

bool paintsAlike(const Style& a, const Style& b) {
    return static_cast<const ColourStyle&>(a) == b && a.detail.mode == b.detail.mode;
}

} // namespace

void PlanPainter::setStyle(const Style& resolved) {
    if (number_ > 0 && paintsAlike(resolved, style_))
        return;
    ++number_;
    style_ = resolved;
    Result<Clips> clips = Clips::make(style_.clipBoxes, style_.clipRegions);
    clips_ = clips.ok() ? std::move(*clips) : Clips();
}

bool PlanPainter::paint(const CloudLoader& cloud, std::uint32_t node, bool exact, CachedNode& cached) {
    std::vector<std::shared_ptr<const NodeColumns>> columns = cached.columns();
    PaintKey key{number_, cached.node->id, columns.size(), exact};
    if (cached.paintKey == key)
        return false;
    const CloudMetadata& metadata = *cloud.opened.metadata;
    const HierarchyNode& known = cloud.hierarchy.node(node);
    Painter painter(style_, clips_, metadata.schema, metadata.grid, metadata.colourIs8Bit,
                    style_.detail.mode == DetailMode::continuous);
    cached.paint =
        painter.paint({cached.node, columns, metadata.rootCube.nodeMin(known.entry.key), known.geometry.box,
                       exact, cloud.hierarchy.densityOf(node), metadata.spacing});
    cached.paintKey = key;
    counters_.nodesPainted += cached.paint != nullptr;
    return true;
}

bool PlanPainter::orient(const CloudLoader& cloud, CachedNode& cached) {
    if (cached.normals)
        return false;
    cached.normals = packNormals(cloud.opened.metadata->schema, cached.columns());
    return cached.normals != nullptr;
}

} // namespace stipple
