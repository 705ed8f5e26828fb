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

std::uint64_t CachedNode::sizeBytes() const {
    std::uint64_t bytes = sizeof *this + compressed.size() + (node ? node->sizeBytes() : 0) +
                          (paint ? paint->sizeBytes() : 0) + (normals ? normals->sizeBytes() : 0);
    for (const CachedBlock& cached : blocks)
        bytes += sizeof cached + (cached.columns ? cached.columns->sizeBytes() : 0);
    return bytes;
}

CachedNode* NodeCache::find(CacheKey key) {
    auto at = entries_.find(key);
    return at == entries_.end() ? nullptr : &at->second.node;
}

CachedNode& NodeCache::obtain(CacheKey key) {
    auto [at, added] = entries_.try_emplace(key);
    if (added) {
        at->second.use = uses_.insert(uses_.begin(), key);
        recount(key);
    }
    return at->second.node;
}

void NodeCache::touch(CacheKey key, std::uint64_t frame) {
    auto at = entries_.find(key);
    if (at == entries_.end())
        return;
    at->second.frame = frame;
    uses_.splice(uses_.begin(), uses_, at->second.use);
}

void NodeCache::recount(CacheKey key) {
    auto at = entries_.find(key);
    if (at == entries_.end())
        return;
    bytes_ -= at->second.bytes;
    at->second.bytes = at->second.node.sizeBytes();
    bytes_ += at->second.bytes;
    peak_ = std::max(peak_, bytes_);
}

std::vector<CacheKey> NodeCache::evict(std::uint64_t limitBytes, std::uint64_t frame) {
    std::vector<CacheKey> evicted;
    while (bytes_ > limitBytes && !uses_.empty()) {
        auto at = entries_.find(uses_.back());
        if (at->second.frame == frame)
            break; // the list is in order of use: so are all before it
        evicted.push_back(at->first);
        drop(at);
    }
    return evicted;
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
    uses_.erase(at->second.use);
    return entries_.erase(at);
}

} // namespace stipple
