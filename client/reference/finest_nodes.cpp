#include "client/reference/finest_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::reference {

Result<FinestNodes> FinestNodes::of(CloudReader& reader) {
    FinestNodes nodes;
    nodes.cube_ = reader.metadata().rootCube;
    nodes.rootSpacing_ = reader.metadata().spacing;
    STIPPLE_CHECK(reader.visitNodes([&](const NodeEntry& entry) -> Status {
        if (entry.pointCount > 0) {
            nodes.keys_.insert(entry.key);
            nodes.deepest_ = std::max(nodes.deepest_, int{entry.key.level});
        }
        return {};
    }));
    return nodes;
}

int FinestNodes::levelAt(const Vec3i& position) const {
    for (int level = deepest_; level > 0; --level)
        if (keys_.contains(cube_.keyOf(position, level)))
            return level;
    return 0;
}

std::vector<double> FinestNodes::spacingsAt(const PointBatch& points) const {
    std::vector<double> spacings;
    for (const Vec3i& position : points.positions)
        spacings.push_back(std::ldexp(rootSpacing_, -levelAt(position)));
    return spacings;
}

} // namespace stipple::reference
