#include "client/render/drawn_octree.hpp"

#include <unordered_map>

namespace stipple {
namespace {

struct Place {
    std::uint32_t cloud = 0;
    NodeKey key;
    friend bool operator==(const Place&, const Place&) = default;
    Place parent() const { return {cloud, key.parent()}; }
    Place child(int index) const { return {cloud, key.child(index)}; }
};
struct PlaceHash {
    std::size_t operator()(const Place& place) const {
        return static_cast<std::size_t>(NodeKeyHash()(place.key) * 0x9E3779B97F4A7C15ull + place.cloud);
    }
};

struct Known {
    bool drawn = false;
    std::uint32_t children = 0; // bits
    std::uint32_t at = 0;       // word
};
using Nodes = std::unordered_map<Place, Known, PlaceHash>;

// Adds the nodes between `place` and the next one above that is known, if there is one.
void connect(Nodes& nodes, const Place& place, std::vector<Place>& chain) {
    chain.clear();
    for (Place above = place; above.key.level > 0;) {
        above = above.parent();
        if (nodes.contains(above)) {
            for (const Place& between : chain)
                nodes.try_emplace(between);
            return;
        }
        chain.push_back(above);
    }
}

// Drawn and awaited nodes and those between them, each knowing its children.
Nodes connectedNodes(const FramePlan& plan) {
    Nodes nodes;
    nodes.reserve(2 * (plan.nodes.size() + plan.awaited.size()));
    std::vector<Place> places, chain;
    for (const DrawNode& node : plan.nodes)
        if (node.node && node.pointCount > 0) {
            places.push_back({node.cloud, node.node->key});
            nodes[places.back()].drawn = true;
        }
    for (const AwaitedNode& node : plan.awaited) {
        places.push_back({node.cloud, node.key});
        nodes[places.back()].drawn = false;
    }
    for (const Place& place : places)
        connect(nodes, place, chain);
    for (auto& [place, known] : nodes)
        if (place.key.level > 0)
            if (auto parent = nodes.find(place.parent()); parent != nodes.end())
                parent->second.children |= 1u << place.key.indexInParent();
    return nodes;
}

} // namespace

DrawnOctree drawnOctree(const FramePlan& plan) {
    Nodes nodes = connectedNodes(plan);
    std::vector<Place> list; // breadth first
    for (const DrawNode& node : plan.nodes) {
        if (!node.node || node.pointCount == 0)
            continue;
        Place place{node.cloud, node.node->key};
        if (place.key.level == 0 || !nodes.contains(place.parent()))
            list.push_back(place);
    }
    DrawnOctree tree;
    for (std::size_t i = 0; i < list.size(); ++i) {
        Known& known = nodes[list[i]];
        known.at = static_cast<std::uint32_t>(i);
        std::uint32_t children = list.size() + 8 <= maxOctreeWords ? known.children : 0;
        tree.words.push_back(static_cast<std::uint32_t>(list.size()) << firstChildShift |
                             (known.drawn ? drawnBit : 0u) | children);
        for (int child = 0; child < 8; ++child)
            if ((children >> child & 1u) != 0)
                list.push_back(list[i].child(child));
    }
    if (tree.words.empty())
        tree.words.push_back(0);
    for (const DrawNode& node : plan.nodes) {
        auto found = node.node ? nodes.find({node.cloud, node.node->key}) : nodes.end();
        tree.places.push_back(found == nodes.end() ? 0 : found->second.at);
    }
    return tree;
}

} // namespace stipple
