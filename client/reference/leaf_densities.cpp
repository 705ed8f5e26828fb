#include "client/reference/leaf_densities.hpp"

namespace stipple::reference {

Result<LeafDensities> LeafDensities::of(CloudReader& reader) {
    LeafDensities densities;
    STIPPLE_CHECK(reader.visitNodes([&](const NodeEntry& entry) -> Status {
        Known& known = densities.nodes_[entry.key];
        known.points = static_cast<double>(entry.pointCount);
        if (entry.key.level > 0)
            ++densities.nodes_[entry.key.parent()].children;
        return {};
    }));
    return densities;
}

double LeafDensities::stepOf(const NodeKey& key) const {
    auto node = nodes_.find(key);
    if (node == nodes_.end() || node->second.children > 0 || key.level == 0)
        return 0;
    auto parent = nodes_.find(key.parent());
    if (parent == nodes_.end() || parent->second.points == 0)
        return 0;
    // A level is three quarters new points, the root all of it.
    double share = key.level == 1 ? 1 : 0.75;
    return parent->second.children * share / parent->second.points;
}

} // namespace stipple::reference
