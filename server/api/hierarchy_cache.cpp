#include "server/api/hierarchy_cache.hpp"

#include "server/api/query.hpp"
#include "shared/base/text.hpp"

#include <charconv>

namespace stipple::server {

namespace {

std::string cacheKey(const CloudVersion& cloud, const ChunkPlace& place) {
    return cat(cloud.validators.etag, "@", place.range.offset);
}

// What a parsed chunk takes, about: entries with their own arrays, and a hash table of their keys.
std::uint64_t sizeOf(const HierarchyNodes& chunk) {
    std::uint64_t bytes = sizeof chunk;
    for (const NodeEntry& node : chunk.nodes)
        bytes += sizeof node + 4 * node.attributeBytes.size() + 64;
    return bytes;
}

Error noSuchNode(const NodeKey& key) {
    return {ErrorCode::notFound, cat("the cloud has no node ", key.text()), "", ""};
}

NodeKey ancestorAt(NodeKey key, int level) {
    while (key.level > level)
        key = key.parent();
    return key;
}

// The deepest node of the chunk on the way to `key`, whose ancestor at `level` begins the chunk.
const NodeEntry* deepestOnWay(const HierarchyNodes& chunk, const NodeKey& key, int level) {
    const NodeEntry* deepest = nullptr;
    for (; level <= key.level; ++level) {
        const NodeEntry* node = chunk.find(ancestorAt(key, level));
        if (!node)
            break;
        deepest = node;
    }
    return deepest;
}

bool isBelow(NodeKey key, const NodeKey& ancestor) {
    return key.level >= ancestor.level && ancestorAt(key, ancestor.level) == ancestor;
}

} // namespace

Result<HierarchyCache::ChunkPtr> HierarchyCache::chunk(const CloudVersion& cloud, ByteSource& source,
                                                       const ChunkPlace& place,
                                                       const std::atomic<bool>& stop) {
    auto read = [&]() -> Result<SharedCache<std::string, HierarchyNodes>::Made> {
        STIPPLE_TRY(nodes, readHierarchyChunk(source, cloud.header, cloud.metadata, place));
        auto chunk = std::make_shared<HierarchyNodes>();
        chunk->nodes = std::move(nodes);
        for (std::size_t i = 0; i < chunk->nodes.size(); ++i)
            chunk->places.emplace(chunk->nodes[i].key, static_cast<std::uint32_t>(i));
        std::uint64_t bytes = sizeOf(*chunk);
        return SharedCache<std::string, HierarchyNodes>::Made{std::move(chunk), bytes};
    };
    return chunks_.get(cacheKey(cloud, place), read, stop);
}

// A chunk is deeper than the one that names it, so both walks end after maxLevel of them at most.

HierarchyCache::Known HierarchyCache::lookUp(const CloudVersion& cloud, const NodeKey& key) {
    ChunkPlace place = rootChunkPlace(cloud.header);
    for (int level = 0;;) {
        ChunkPtr chunk = chunks_.find(cacheKey(cloud, place));
        if (!chunk)
            return Unknown{};
        const NodeEntry* node = deepestOnWay(*chunk, key, level);
        if (node && node->key == key)
            return *node;
        if (!node || node->childChunk.size == 0)
            return Absent{};
        place = childChunkPlace(*node);
        level = node->key.level + 1;
    }
}

Result<NodeEntry> HierarchyCache::find(const CloudVersion& cloud, ByteSource& source, const NodeKey& key,
                                       const std::atomic<bool>& stop) {
    ChunkPlace place = rootChunkPlace(cloud.header);
    for (int level = 0;;) {
        STIPPLE_TRY(chunk, this->chunk(cloud, source, place, stop));
        const NodeEntry* node = deepestOnWay(*chunk, key, level);
        if (node && node->key == key)
            return *node;
        if (!node || node->childChunk.size == 0)
            return noSuchNode(key);
        place = childChunkPlace(*node);
        level = node->key.level + 1;
    }
}

Result<std::vector<NodeEntry>> HierarchyCache::below(const CloudVersion& cloud, ByteSource& source,
                                                     const NodeKey& key, const std::atomic<bool>& stop) {
    ChunkPlace place = rootChunkPlace(cloud.header);
    std::vector<NodeEntry> nodes;
    for (int level = 0;;) {
        STIPPLE_TRY(chunk, this->chunk(cloud, source, place, stop));
        const NodeEntry* node = deepestOnWay(*chunk, key, level);
        if (!node)
            return noSuchNode(key);
        if (node->key != key && node->childChunk.size == 0)
            return noSuchNode(key);
        if (node->key == key && node->childChunk.size == 0) {
            for (const NodeEntry& entry : chunk->nodes)
                if (isBelow(entry.key, key))
                    nodes.push_back(entry);
            return nodes;
        }
        place = childChunkPlace(*node);
        if (node->key == key) {
            STIPPLE_TRY(children, this->chunk(cloud, source, place, stop));
            nodes.push_back(*node);
            nodes.insert(nodes.end(), children->nodes.begin(), children->nodes.end());
            return nodes;
        }
        level = node->key.level + 1;
    }
}

std::optional<NodeKey> nodeKeyFromText(std::string_view text) {
    std::vector<std::string_view> parts = splitAt(text, '-');
    std::uint32_t numbers[4];
    if (parts.size() != 4)
        return std::nullopt;
    for (std::size_t i = 0; i < 4; ++i) {
        std::string_view part = parts[i];
        auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), numbers[i]);
        bool isPlain = error == std::errc() && end == part.data() + part.size() &&
                       (part.size() == 1 || part.front() != '0');
        if (!isPlain || (i == 0 && numbers[0] > maxLevel) ||
            (i > 0 && numbers[i] >= std::uint64_t{1} << numbers[0]))
            return std::nullopt;
    }
    return NodeKey{static_cast<std::uint8_t>(numbers[0]), numbers[1], numbers[2], numbers[3]};
}

} // namespace stipple::server
