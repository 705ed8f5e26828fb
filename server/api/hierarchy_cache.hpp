// Where the nodes of clouds are in their files: hierarchy chunks, read when they are needed, parsed once and
// kept while there is room. Thread: any.
#pragma once

#include "server/cache/shared_cache.hpp"
#include "server/site/cloud_version.hpp"
#include "shared/format/cloud_file.hpp"

#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

namespace stipple::server {

// A parsed chunk, nodes breadth first.
struct HierarchyNodes {
    std::vector<NodeEntry> nodes;
    std::unordered_map<NodeKey, std::uint32_t, NodeKeyHash> places;

    const NodeEntry* find(const NodeKey& key) const {
        auto found = places.find(key);
        return found == places.end() ? nullptr : &nodes[found->second];
    }
};

class HierarchyCache {
  public:
    explicit HierarchyCache(std::uint64_t maxBytes) : chunks_(maxBytes) {}

    // What the chunks that are here say of a node, without reading any.
    struct Unknown {};
    struct Absent {};
    using Known = std::variant<Unknown, Absent, NodeEntry>;
    Known lookUp(const CloudVersion& cloud, const NodeKey& key);

    // The node, reading chunks from `source` on the way to it. Errors: notFound; those of reading and
    // parsing; cancelled once `stop`.
    Result<NodeEntry> find(const CloudVersion& cloud, ByteSource& source, const NodeKey& key,
                           const std::atomic<bool>& stop);
    // The node and those below it, breadth first, as far as one chunk describes them: the chunk that has its
    // children.
    Result<std::vector<NodeEntry>> below(const CloudVersion& cloud, ByteSource& source, const NodeKey& key,
                                         const std::atomic<bool>& stop);

    CacheCounts counts() const { return chunks_.counts(); }

  private:
    using ChunkPtr = std::shared_ptr<const HierarchyNodes>;
    Result<ChunkPtr> chunk(const CloudVersion& cloud, ByteSource& source, const ChunkPlace& place,
                           const std::atomic<bool>& stop);

    SharedCache<std::string, HierarchyNodes> chunks_;
};

// "level-x-y-z" as NodeKey::text() writes it: decimal without leading zeros, level at most maxLevel, the
// others below 2^level. Nothing for anything else.
std::optional<NodeKey> nodeKeyFromText(std::string_view text);

} // namespace stipple::server
