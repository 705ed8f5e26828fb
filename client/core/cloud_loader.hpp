// One cloud of a session: how far it is opened, its hierarchy, and what of each node can be drawn. It says
// what to load and takes in what was loaded; asking, decoding and caching are SessionLoading's.
#pragma once

#include "client/core/attribute_needs.hpp"
#include "client/core/hierarchy.hpp"
#include "client/core/kept_bytes.hpp"
#include "client/core/load_queue.hpp"
#include "client/core/node_cache.hpp"
#include "client/core/node_source.hpp"
#include "client/core/selection.hpp"
#include "client/core/view_session.hpp"

#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

namespace stipple {

struct CloudLoader {
    CloudState state;
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<NodeSource> format;
    FetchedRanges fetched; // while opening, and the first request afterwards: the root's bytes are in it
    std::optional<ByteRange> openingNeeds;
    bool isToOpen = true;       // by the present view (openings.hpp)
    bool opensAnywhere = false; // whatever the view
    OpenedCloud opened;
    Hierarchy hierarchy;
    std::vector<NodeResidency> residency;                  // parallel to hierarchy's nodes
    std::unordered_map<std::uint32_t, int> decodeFailures; // by node
    std::set<std::uint32_t> damagedChunks;                 // by node above; fetched once more
    std::vector<std::uint32_t> lostNodes, lostChunks;      // given up until retry(); chunks by node above
    AttributeNeeds needs;                                  // of the style
    AttributeNeeds watched;    // of whoever counts what is in view; nodes are drawn without them
    KeptBytes* kept = nullptr; // of the session
    std::optional<std::chrono::steady_clock::time_point> reloadedAt; // its file was replaced

    bool ready() const { return state.stage == CloudStage::ready; }
    bool opening() const { return state.stage == CloudStage::opening && isToOpen; }
    // World box of its points, as far as it is known; empty: not at all.
    BoxD place() const { return ready() ? opened.metadata->worldBounds() : state.expected; }

    // Empty unless ready.
    Bytes metadataBlock() const;

    // Opens as far as the fetched bytes allow; the state afterwards says how far.
    void advanceOpening();
    void fail(const Error& error);
    // To the state of a cloud that was just added, with the same source.
    void reset();
    // A file that is replaced again soon is another one with each answer, as far as anybody can tell.
    bool mayReload(std::chrono::steady_clock::time_point now) const {
        return ready() && (!reloadedAt || now - *reloadedAt > std::chrono::minutes(10));
    }
    void loseNode(std::uint32_t node, const Error& why);
    void loseChunk(std::uint32_t parent, const Error& why);
    void takeUpLost(); // all of it is wanted again
    // The error with the source's name in its place.
    Error placed(const Error& error) const;
    // Takes in a chunk with the children of node `parent`. After an error all is as it was.
    Status addChunk(std::uint32_t parent, ByteSpan block);
    // Renews what can be drawn of a node from its cache entry (null: none).
    void updateResidency(std::uint32_t node, const CachedNode* cached);

    // Loads, if any: what is already in the fetched bytes is its `head`, `range` the rest.
    std::optional<LoadItem> openingItem() const;
    LoadItem chunkItem(std::uint32_t parent) const;
    std::optional<LoadItem> pictureItem(std::uint32_t node, int strata, const CachedNode* cached) const;
    // All bytes of a node, whatever is here of it already (LoadKind::points).
    LoadItem pointsItem(std::uint32_t node) const;
    // Bytes for a region's scan (LoadKind::region), of which `head`, if there is one, is here.
    LoadItem regionItem(ByteRange range, const Bytes* head) const;
    // The further blocks that the style needs, those that are watched, or one of them.
    void addBlockItems(std::uint32_t node, const CachedNode* cached, std::vector<LoadItem>& items) const;
    void addWatchedItems(std::uint32_t node, const CachedNode* cached, std::vector<LoadItem>& items) const;
    // Whether a node that can be drawn has its exact colours in a block that is not here, or still on its
    // way.
    bool lacksExact(std::uint32_t node, const CachedNode& cached) const;
    // What is watched of a node that can be drawn is here.
    bool hasWatched(std::uint32_t node, const CachedNode& cached) const;
    std::optional<LoadItem> blockItem(std::uint32_t node, int block, const CachedNode* cached) const;

  private:
    LoadItem itemFor(LoadKind kind, std::uint64_t id, ByteRange range) const;
};

using CloudMap = std::map<CloudId, CloudLoader>;

} // namespace stipple
