#include "client/core/load_list.hpp"

#include "client/core/load_value.hpp"
#include "client/core/openings.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

namespace stipple {

namespace {

// What to ask for of a node, and what it is worth.
struct NodeLoad {
    double valuePerByte = 0;
    std::vector<LoadItem> items;
};

// The fewest further strata that are worth a request.
int nextPiece(const NodeEntry& entry, int have, int wanted, std::uint64_t pieceBytes) {
    std::uint64_t before = entry.strataRange(have).size;
    for (int strata = have + 1; strata < wanted; ++strata)
        if (entry.strataRange(strata).size - before >= pieceBytes)
            return strata;
    return wanted;
}

class LoadList {
  public:
    LoadList(const SessionView& view, SessionLoading& loading, const SessionLimits& limits)
        : view_(view), loading_(loading), limits_(limits) {}

    std::vector<LoadItem> take() { return std::move(items_); }

    void addOpenings() {
        std::vector<std::pair<double, LoadItem>> openings;
        for (auto& [id, cloud] : loading_.clouds())
            if (auto item = cloud.openingItem())
                openings.emplace_back(openingPixels(cloud, view_), std::move(*item));
        std::stable_sort(openings.begin(), openings.end(),
                         [](const auto& a, const auto& b) { return a.first > b.first; });
        for (auto& [pixels, item] : openings)
            items_.push_back(std::move(item));
    }
    void addQuestions() {
        for (auto& [id, cloud] : loading_.clouds())
            for (LoadItem& item : loading_.pointQueries().items(cloud))
                items_.push_back(std::move(item));
    }
    void addChunks() {
        for (const WantedChunk& chunk : view_.selection.chunks)
            items_.push_back(view_.cloudOf(loading_.clouds(), chunk).chunkItem(chunk.node));
    }

    void addNodes() {
        std::uint64_t pieceBytes = loading_.loadLimits(limits_).pieceBytes;
        std::vector<NodeLoad> loads;
        for (const WantedNode& wanted : view_.selection.loads)
            loads.push_back(nodeLoad(wanted, pieceBytes));
        if (limits_.techniques.byValue)
            std::stable_sort(loads.begin(), loads.end(), [](const NodeLoad& a, const NodeLoad& b) {
                return a.valuePerByte > b.valuePerByte;
            });
        for (NodeLoad& load : loads)
            std::move(load.items.begin(), load.items.end(), std::back_inserter(items_));
    }

    void addExactColours() {
        for (const auto& [cloudIndex, node] : view_.exact) {
            CloudLoader& cloud = loading_.clouds().at(view_.clouds[cloudIndex]);
            const CachedNode* cached = loading_.cache().find({view_.clouds[cloudIndex], node});
            if (auto item = cloud.blockItem(node, cloud.needs.exactBlock, cached);
                item && !cloud.residency[node].failed)
                items_.push_back(std::move(*item));
        }
    }
    void addWatched() {
        for (const SelectedNode& selected : view_.selection.nodes)
            view_.cloudOf(loading_.clouds(), selected)
                .addWatchedItems(selected.node, loading_.cache().find(view_.cacheKey(selected)), items_);
    }

    // The picture may want the same chunks.
    void addRegions() {
        std::set<LoadKey> chunks;
        for (const LoadItem& item : items_)
            if (item.key.kind == LoadKind::chunk)
                chunks.insert(item.key);
        for (LoadItem& item : loading_.regionScans().items(loading_.clouds(), loading_.cache()))
            if (item.key.kind != LoadKind::chunk || chunks.insert(item.key).second)
                items_.push_back(std::move(item));
    }

  private:
    NodeLoad nodeLoad(const WantedNode& wanted, std::uint64_t pieceBytes) {
        CloudLoader& cloud = view_.cloudOf(loading_.clouds(), wanted);
        const CachedNode* cached = loading_.cache().find(view_.cacheKey(wanted));
        const NodeEntry& entry = cloud.hierarchy.node(wanted.node).entry;
        int have = cached ? cached->strataFetched : 0, strata = std::max(have, wanted.strata);
        if (limits_.techniques.byValue && limits_.techniques.prefixes)
            strata = nextPiece(entry, have, strata, pieceBytes);
        NodeLoad load;
        if (auto item = cloud.pictureItem(wanted.node, strata, cached))
            load.items.push_back(std::move(*item));
        cloud.addBlockItems(wanted.node, cached, load.items);
        std::uint64_t bytes = 1;
        for (const LoadItem& item : load.items)
            bytes += item.range.size;
        std::uint32_t from = have < strata ? strataPrefixPoints(entry.pointCount, have) : 0;
        load.valuePerByte = loadValue(view_.transform, view_.height, cloud.hierarchy, wanted.node, from,
                                      strataPrefixPoints(entry.pointCount, strata)) /
                            static_cast<double>(bytes);
        return load;
    }

    const SessionView& view_;
    SessionLoading& loading_;
    const SessionLimits& limits_;
    std::vector<LoadItem> items_;
};

} // namespace

std::vector<LoadItem> loadList(const SessionView& view, SessionLoading& loading, const SessionLimits& limits,
                               bool isWatching) {
    LoadList list(view, loading, limits);
    list.addOpenings();
    list.addQuestions(); // somebody waits for the answer
    list.addChunks();    // small, and what they hide may matter more than any node that is known
    list.addNodes();
    list.addExactColours();
    if (isWatching)
        list.addWatched();
    list.addRegions();
    return list.take();
}

} // namespace stipple
