// What is held of nodes: compressed strata of those that are not complete (so that refining one asks for no
// byte twice) and the decoded points. Both are bounded in bytes, each for itself. What was used longest ago
// goes first; a node of the next finer level as if that had been `framesPerLevel` frames earlier, for a view
// comes sooner back to what is coarse.
#pragma once

#include "client/core/node_normals.hpp"
#include "client/core/node_paint.hpp"
#include "client/core/resident_node.hpp"
#include "shared/base/bytes.hpp"

#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

namespace stipple {

struct CacheKey {
    std::uint32_t cloud = 0; // id
    std::uint32_t node = 0;  // index in its hierarchy
    friend auto operator<=>(const CacheKey&, const CacheKey&) = default;
};

// A block of attributes of a node.
struct CachedBlock {
    int block = 0;
    bool decoding = false;                      // a job is on its way
    std::shared_ptr<const NodeColumns> columns; // null: not here yet
};

// What a paint depends on.
struct PaintKey {
    std::uint64_t style = 0; // number of the style
    std::uint64_t node = 0;  // ResidentNode::id
    std::size_t blocks = 0;  // that are here
    bool exact = false;
    friend bool operator==(const PaintKey&, const PaintKey&) = default;
};

struct CachedNode {
    Bytes compressed;                         // of the strata fetched; empty once the node is complete
    int strataFetched = 0;                    // 0..4
    bool decodingPicture = false;             // a job is on its way
    int strataDecoding = 0;                   // of that job
    std::shared_ptr<const ResidentNode> node; // what can be drawn; null at first
    std::vector<CachedBlock> blocks;
    std::shared_ptr<const NodePaint> paint; // as of paintKey; null: the node needs none
    PaintKey paintKey;
    std::shared_ptr<const NodeNormals> normals; // packed of the blocks, once discs were drawn

    const CachedBlock* block(int index) const;
    bool hasBlock(int index) const { return block(index) && block(index)->columns; }
    // Of all blocks that are here.
    std::vector<std::shared_ptr<const NodeColumns>> columns() const;
    std::uint64_t decodedBytes() const; // all but `compressed`
};

class NodeCache {
  public:
    static constexpr int framesPerLevel = 60;

    CachedNode* find(CacheKey key);              // null if absent; does not count as use
    CachedNode& obtain(CacheKey key, int level); // adds an empty one if absent
    // Marks as used in frame `frame`, which never gets less; nothing happens if absent.
    void touch(CacheKey key, std::uint64_t frame);
    // To be called when an entry's contents changed: its bytes are counted again.
    void recount(CacheKey key);
    struct Evicted {
        CacheKey key;
        Bytes compressed; // as it was
    };
    // Drops entries until at most `limitBytes` of decoded points are held; never one that was used in frame
    // `frame`.
    std::vector<Evicted> evict(std::uint64_t limitBytes, std::uint64_t frame);
    // Likewise compressed strata, where at most `limitBytes` of them are to be held. Refining those nodes
    // begins anew. The number of nodes.
    std::size_t dropCompressed(std::uint64_t limitBytes, std::uint64_t frame);
    void erase(CacheKey key);
    // Calls `change(key, node)` for each entry, which answers whether it changed its contents.
    template <class Change>
    void visit(const Change& change) {
        for (auto& [key, entry] : entries_)
            if (change(key, entry.node))
                recount(key);
    }
    void eraseCloud(std::uint32_t cloud);

    std::uint64_t decodedBytes() const { return bytes_; }
    std::uint64_t decodedBytesPeak() const { return peak_; }
    std::uint64_t compressedBytes() const { return compressed_; }
    std::size_t size() const { return entries_.size(); }

  private:
    struct Entry {
        CachedNode node;
        int level = 0;
        std::uint64_t bytes = 0, compressed = 0; // as counted
        std::uint64_t frame = 0, turn = 0;       // of the last use
    };
    // What goes first is least: frames, with those of the level, then turns.
    using Use = std::tuple<std::int64_t, std::uint64_t, CacheKey>;
    static Use useOf(CacheKey key, const Entry& entry) {
        return {static_cast<std::int64_t>(entry.frame) - framesPerLevel * entry.level, entry.turn, key};
    }
    std::map<CacheKey, Entry>::iterator drop(std::map<CacheKey, Entry>::iterator at);

    std::map<CacheKey, Entry> entries_;
    std::set<Use> uses_;
    std::uint64_t bytes_ = 0, peak_ = 0, compressed_ = 0;
    std::uint64_t lastFrame_ = 0, lastTurn_ = 0;
};

} // namespace stipple
