#include "server/upstream/block_cache.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <chrono>

namespace stipple::server {

namespace {

Error cancelledError() {
    return {ErrorCode::cancelled, "the request was taken back", "", ""};
}

} // namespace

// The blocks that one call of get() fetches. However it ends, those that wait for them go on.
class BlockCache::Claim {
  public:
    Claim(BlockCache& cache, const File& file) : cache_(cache), file_(file) {}
    ~Claim() {
        std::lock_guard lock(cache_.mutex_);
        for (auto& [index, loading] : loadings_)
            end(index, *loading, nullptr);
        cache_.over_.notify_all();
    }
    Claim(const Claim&) = delete;
    Claim& operator=(const Claim&) = delete;

    void addLocked(std::uint64_t index) {
        auto loading = std::make_shared<Loading>();
        cache_.loading_[{file_.number, index}] = loading;
        loadings_.emplace_back(index, std::move(loading));
    }
    bool isEmpty() const { return loadings_.empty(); }

    // The first of those that are left, with the neighbours behind it.
    Run next() const {
        Run run{loadings_.front().first, 1};
        while (run.count < loadings_.size() && loadings_[run.count].first == run.first + run.count)
            ++run.count;
        return run;
    }
    void succeed(std::vector<Block> blocks) {
        std::lock_guard lock(cache_.mutex_);
        for (std::size_t i = 0; i < blocks.size(); ++i)
            end(loadings_[i].first, *loadings_[i].second, std::move(blocks[i]));
        loadings_.erase(loadings_.begin(), loadings_.begin() + static_cast<std::ptrdiff_t>(blocks.size()));
        cache_.over_.notify_all();
    }
    void fail(const Error& error) { error_ = error; }

  private:
    void end(std::uint64_t index, Loading& loading, Block block) { // locked
        Key key{file_.number, index};
        cache_.loading_.erase(key);
        loading.isOver = true;
        loading.block = block;
        if (block)
            cache_.keepLocked(key, std::move(block));
        else
            loading.error = error_;
    }

    BlockCache& cache_;
    const File file_;
    std::vector<std::pair<std::uint64_t, LoadingPtr>> loadings_; // in order
    Error error_ = cancelledError();
};

BlockCache::Run BlockCache::blocksOf(ByteRange range) {
    if (range.size == 0)
        return {range.offset / blockBytes, 0};
    std::uint64_t first = range.offset / blockBytes;
    return {first, (range.end() - 1) / blockBytes - first + 1};
}

Block BlockCache::find(const File& file, std::uint64_t index) {
    std::lock_guard lock(mutex_);
    Block block = findLocked({file.number, index});
    counts_.hits += block != nullptr;
    return block;
}

Result<std::vector<Block>> BlockCache::get(const File& file, Run run, const Fetch& fetch,
                                           const std::atomic<bool>& stop) {
    std::vector<Block> blocks(static_cast<std::size_t>(run.count));
    std::vector<LoadingPtr> others(blocks.size());
    Claim claim(*this, file);
    {
        std::lock_guard lock(mutex_);
        for (std::size_t i = 0; i < blocks.size(); ++i) {
            Key key{file.number, run.first + i};
            auto loading = loading_.find(key);
            if ((blocks[i] = findLocked(key)))
                ++counts_.hits;
            else if (loading != loading_.end())
                others[i] = loading->second, ++counts_.waits;
            else
                claim.addLocked(key.index), ++counts_.misses;
        }
    }
    // Its own first, then what others fetch: nobody waits in a circle.
    while (!claim.isEmpty()) {
        Run missing = claim.next();
        std::uint64_t offset = missing.first * blockBytes;
        ByteRange range{offset, std::min(missing.count * blockBytes, file.sizeBytes - offset)};
        Result<Bytes> bytes = stop ? Result<Bytes>(cancelledError()) : fetch(range);
        if (bytes && bytes->size() != range.size)
            bytes = Error{ErrorCode::truncated,
                          cat("asked for ", range.size, " bytes, there were ", bytes->size()), "", ""};
        if (!bytes) {
            claim.fail(bytes.error());
            return bytes.error();
        }
        std::vector<Block> fetched;
        for (std::uint64_t at = 0; at < range.size; at += blockBytes) {
            auto from = bytes->begin() + static_cast<std::ptrdiff_t>(at);
            auto size = static_cast<std::ptrdiff_t>(std::min(blockBytes, range.size - at));
            fetched.push_back(std::make_shared<const Bytes>(from, from + size));
            blocks[static_cast<std::size_t>(missing.first - run.first) + fetched.size() - 1] = fetched.back();
        }
        claim.succeed(std::move(fetched));
    }
    for (std::size_t i = 0; i < blocks.size(); ++i)
        if (others[i]) {
            STIPPLE_TRY(block, await(file, run.first + i, others[i], fetch, stop));
            blocks[i] = block;
        }
    return blocks;
}

Result<Block> BlockCache::await(const File& file, std::uint64_t index, const LoadingPtr& loading,
                                const Fetch& fetch, const std::atomic<bool>& stop) {
    constexpr std::chrono::milliseconds untilLookingAtStop{20};
    {
        std::unique_lock lock(mutex_);
        while (!loading->isOver && !stop)
            over_.wait_for(lock, untilLookingAtStop);
        if (!loading->isOver)
            return cancelledError();
        if (loading->block)
            return loading->block;
        if (loading->error->code != ErrorCode::cancelled)
            return *loading->error;
    }
    // Whoever fetched it gave up, which is no failure of the upstream's.
    STIPPLE_TRY(own, get(file, {index, 1}, fetch, stop));
    return own.front();
}

CacheCounts BlockCache::counts() const {
    std::lock_guard lock(mutex_);
    return counts_;
}

Block BlockCache::findLocked(const Key& key) {
    auto found = places_.find(key);
    if (found == places_.end())
        return nullptr;
    entries_.splice(entries_.begin(), entries_, found->second);
    return found->second->block;
}

void BlockCache::keepLocked(const Key& key, Block block) {
    std::uint64_t bytes = block->size();
    if (bytes > maxBytes_)
        return;
    entries_.push_front({key, std::move(block)});
    places_[key] = entries_.begin();
    for (counts_.bytes += bytes; counts_.bytes > maxBytes_; ++counts_.evicted) {
        counts_.bytes -= entries_.back().block->size();
        places_.erase(entries_.back().key);
        entries_.pop_back();
    }
}

} // namespace stipple::server
