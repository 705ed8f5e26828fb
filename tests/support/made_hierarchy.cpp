#include "tests/support/made_hierarchy.hpp"

#include <cstdio>
#include <cstdlib>

namespace stipple::test {
namespace {

std::shared_ptr<const CloudMetadata> metadataOf(const MadeHierarchyOptions& options) {
    auto metadata = std::make_shared<CloudMetadata>();
    metadata->grid.scale = {0.001, 0.001, 0.001};
    metadata->rootCube = {{0, 0, 0}, options.rootBits};
    std::int64_t side = std::int64_t{1} << options.rootBits;
    metadata->bounds.extend(Vec3i{0, 0, 0});
    metadata->bounds.extend(Vec3i{side - 1, side - 1, side / 1024});
    metadata->pointCount = std::uint64_t{options.nodes} * options.pointsPerNode;
    metadata->spacing = static_cast<double>(side) * 0.001 / 128;
    return metadata;
}

} // namespace

Hierarchy makeHierarchy(const MadeHierarchyOptions& options) {
    std::vector<NodeEntry> nodes(1);
    nodes.reserve(options.nodes);
    for (std::size_t parent = 0; nodes.size() < options.nodes; ++parent)
        for (int child = 0; child < 4 && nodes.size() < options.nodes; ++child) {
            nodes[parent].childMask |= static_cast<std::uint8_t>(1 << child);
            NodeEntry entry;
            entry.key = nodes[parent].key.child(child);
            nodes.push_back(entry);
        }
    for (NodeEntry& entry : nodes)
        entry.pointCount = options.pointsPerNode;
    auto created = Hierarchy::create(metadataOf(options), std::move(nodes));
    if (!created.ok()) {
        std::fprintf(stderr, "%s\n", created.error().sentence().c_str());
        std::abort();
    }
    return std::move(*created);
}

} // namespace stipple::test
