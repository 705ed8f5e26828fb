#include "client/core/node_cache.hpp"

#include <algorithm>

namespace stipple {

const CachedBlock* CachedNode::block(int index) const {
    auto at = std::find_if(blocks.begin(), blocks.end(),
                           [&](const CachedBlock& cached) { return cached.block == index; });
    return at == blocks.end() ? nullptr : &*at;
}

std::vector<std::shared_ptr<const NodeColumns>> CachedNode::columns() const {
    std::vector<std::shared_ptr<const NodeColumns>> here;
    for (const CachedBlock& cached : blocks)
        if (cached.columns)
            here.push_back(cached.columns);
    return here;
}

std::uint64_t CachedNode::decodedBytes() const {
    std::uint64_t bytes = sizeof *this + (node ? node->sizeBytes() : 0) + (paint ? paint->sizeBytes() : 0) +
                          (normals ? normals->sizeBytes() : 0);
    for (const CachedBlock& cached : blocks)
        bytes += sizeof cached + (cached.columns ? cached.columns->sizeBytes() : 0);
    return bytes;
}

CachedNode* NodeCache::find(CacheKey key) {
    auto at = entries_.find(key);
    return at == entries_.end() ? nullptr : &at->second.node;
}

CachedNode& NodeCache::obtain(CacheKey key, int level) {
    auto [at, added] = entries_.try_emplace(key);
    if (added) {
        at->second.level = level;
        at->second.turn = ++lastTurn_;
        at->second.frame = lastFrame_ == 0 ? 0 : lastFrame_ - 1; // no frame has used it yet
        uses_.insert(useOf(key, at->second));
        recount(key);
    }
    return at->second.node;
}

void NodeCache::touch(CacheKey key, std::uint64_t frame) {
    auto at = entries_.find(key);
    if (at == entries_.end())
        return;
    uses_.erase(useOf(key, at->second));
    at->second.frame = lastFrame_ = frame;
    at->second.turn = ++lastTurn_;
    uses_.insert(useOf(key, at->second));
}

void NodeCache::recount(CacheKey key) {
    auto at = entries_.find(key);
    if (at == entries_.end())
        return;
    Entry& entry = at->second;
    bytes_ -= entry.bytes;
    compressed_ -= entry.compressed;
    entry.bytes = entry.node.decodedBytes();
    entry.compressed = entry.node.compressed.size();
    bytes_ += entry.bytes;
    compressed_ += entry.compressed;
    peak_ = std::max(peak_, bytes_);
}

std::vector<NodeCache::Evicted> NodeCache::evict(std::uint64_t limitBytes, std::uint64_t frame) {
    std::vector<Evicted> evicted;
    for (auto use = uses_.begin(); bytes_ > limitBytes && use != uses_.end();) {
        auto at = entries_.find(std::get<CacheKey>(*use));
        ++use;
        if (at->second.frame == frame)
            continue;
        evicted.push_back({at->first, std::move(at->second.node.compressed)});
        drop(at);
    }
    return evicted;
}

std::size_t NodeCache::dropCompressed(std::uint64_t limitBytes, std::uint64_t frame) {
    std::size_t nodes = 0;
    for (auto use = uses_.begin(); compressed_ > limitBytes && use != uses_.end(); ++use) {
        CacheKey key = std::get<CacheKey>(*use);
        Entry& entry = entries_.at(key);
        CachedNode& node = entry.node;
        if (node.compressed.empty() || entry.frame == frame)
            continue; // who drops what is being refined would fetch it again and again
        node.compressed = {};
        node.strataFetched = 0;
        recount(key);
        ++nodes;
    }
    return nodes;
}

void NodeCache::erase(CacheKey key) {
    if (auto at = entries_.find(key); at != entries_.end())
        drop(at);
}

void NodeCache::eraseCloud(std::uint32_t cloud) {
    auto at = entries_.lower_bound({cloud, 0});
    while (at != entries_.end() && at->first.cloud == cloud)
        at = drop(at);
}

std::map<CacheKey, NodeCache::Entry>::iterator NodeCache::drop(std::map<CacheKey, Entry>::iterator at) {
    bytes_ -= at->second.bytes;
    compressed_ -= at->second.compressed;
    uses_.erase(useOf(at->first, at->second));
    return entries_.erase(at);
}

} // namespace stipple
