// What a session looks at, and what the selection made of it: what choosing, asking and planning share.
#pragma once

#include "client/core/clips.hpp"
#include "client/core/cloud_loader.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/selection.hpp"
#include "client/core/style.hpp"
#include "client/core/view_session.hpp"

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

namespace stipple {

struct SessionView {
    Camera camera;
    int width = 1280, height = 720; // pixels
    Style style;
    Clips clips; // of the style
    ViewTransform transform;
    Selection selection;
    std::vector<CloudId> clouds; // of the selection's cloud indices
    // Nodes (cloud index, node) of which and below which nothing that shows is coarse (exact_nodes.hpp).
    std::set<std::pair<std::uint32_t, std::uint32_t>> exact;

    bool drawsDiscs() const { return style.shape == PointShape::disc; }
    // Of a SelectedNode or WantedNode.
    template <class Node>
    CacheKey cacheKey(const Node& node) const {
        return {clouds[node.cloud], node.node};
    }
    // Of a SelectedNode, WantedNode or WantedChunk.
    template <class Node>
    CloudLoader& cloudOf(CloudMap& map, const Node& node) const {
        return map.at(clouds[node.cloud]);
    }
    template <class Node>
    const CloudLoader& cloudOf(const CloudMap& map, const Node& node) const {
        return map.at(clouds[node.cloud]);
    }
    // Lets go of what was selected.
    void forget() {
        selection = {};
        exact.clear();
        clouds.clear();
    }
};

} // namespace stipple
