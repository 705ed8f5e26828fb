#include "client/core/cloud_needs.hpp"

#include "client/core/clips.hpp"
#include "client/core/node_normals.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stipple {

namespace {

bool needsBlock(const AttributeNeeds& needs, int block) {
    return block == needs.exactBlock ||
           std::find(needs.blocks.begin(), needs.blocks.end(), block) != needs.blocks.end();
}

} // namespace

bool updateNeeds(CloudMap& clouds, NodeCache& cache, const Style& style, bool all) {
    bool changed = false;
    for (auto& [id, cloud] : clouds) {
        AttributeNeeds needs;
        if (cloud.ready())
            needs = all ? needsOfAll(style, *cloud.opened.metadata) : needsOf(style, *cloud.opened.metadata);
        if (needs == cloud.needs)
            continue;
        cloud.needs = std::move(needs);
        changed = true;
        for (std::uint32_t node = 0; node < cloud.residency.size(); ++node)
            cloud.updateResidency(node, cache.find({id, node}));
    }
    return changed;
}

void updateWatched(CloudMap& clouds, const std::vector<std::string>& names) {
    ColourStyle looking; // that needs these attributes and nothing else
    looking.colourMode = ColourMode::elevation;
    for (const std::string& name : names)
        looking.filters.push_back({name, -HUGE_VAL, HUGE_VAL});
    for (auto& [id, cloud] : clouds)
        cloud.watched = cloud.ready() ? needsOf(looking, *cloud.opened.metadata) : AttributeNeeds();
}

std::uint32_t bytesPerPoint(const CloudLoader& cloud, const Style& style) {
    const CloudMetadata& metadata = *cloud.opened.metadata;
    bool wide = metadata.rootCube.bits > positionWordBits;
    bool painted = style.colourMode != ColourMode::rgb || cloud.needs.exactBlock >= 0 ||
                   !style.clipBoxes.empty() || !style.clipRegions.empty() || hidesPoints(style);
    bool oriented = style.shape == PointShape::disc && normalAttributes(metadata.schema);
    return 12u + (wide ? 4u : 0u) + (painted ? 4u : 0u) + (oriented ? 4u : 0u) +
           columnBytes(cloud.needs, metadata) + (cloud.needs.exactBlock >= 0 ? 4u : 0u);
}

std::uint64_t dropUnused(const CloudMap& clouds, NodeCache& cache, const Style& style) {
    std::uint64_t blocks = 0;
    cache.visit([&](CacheKey key, CachedNode& cached) {
        auto cloud = clouds.find(key.cloud);
        if (cloud == clouds.end())
            return false;
        bool drawsDiscs = style.shape == PointShape::disc;
        bool packed = !drawsDiscs && std::exchange(cached.normals, nullptr) != nullptr;
        auto dropped = std::erase_if(cached.blocks, [&](const CachedBlock& one) {
            return !one.decoding && !needsBlock(cloud->second.needs, one.block) &&
                   !needsBlock(cloud->second.watched, one.block);
        });
        blocks += dropped;
        return dropped > 0 || packed;
    });
    return blocks;
}

} // namespace stipple
