// Aligned blocks of files that lie elsewhere, shared by all that read them. Bounded by bytes, the least
// recently used leave first. A block that several want at once is fetched by one of them while the others
// wait; neighbours that are missing come in one request. Thread: any.
#pragma once

#include "server/cache/shared_cache.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <vector>

namespace stipple::server {

using Block = std::shared_ptr<const Bytes>; // blockBytes of them, fewer at the end of the file

class BlockCache {
  public:
    static constexpr std::uint64_t blockBytes = 256 * 1024;

    struct File {
        std::uint64_t number = 0; // of one version of one file, never given again
        std::uint64_t sizeBytes = 0;
    };
    struct Run { // of neighbours
        std::uint64_t first = 0, count = 0;
    };
    static Run blocksOf(ByteRange range); // that hold it; of an empty range none
    // Asks for whole blocks: exactly the bytes of the range, or an error.
    using Fetch = std::function<Result<Bytes>(ByteRange range)>;

    explicit BlockCache(std::uint64_t maxBytes) : maxBytes_(maxBytes) {}

    // Null if it is not there; doesn't wait.
    Block find(const File& file, std::uint64_t index);

    // The blocks of a run inside the file. Memory: the run's, which the caller bounds. Errors: those of
    // `fetch`, also of another caller's who fetched what this one waited for (but not its `cancelled`);
    // `cancelled` once `stop` is set.
    Result<std::vector<Block>> get(const File& file, Run run, const Fetch& fetch,
                                   const std::atomic<bool>& stop);

    CacheCounts counts() const;

  private:
    struct Key {
        std::uint64_t number, index;
        friend bool operator==(const Key&, const Key&) = default;
    };
    struct KeyHash {
        std::size_t operator()(const Key& key) const {
            return std::hash<std::uint64_t>{}(key.number * 0x9E3779B97F4A7C15u + key.index);
        }
    };
    struct Entry {
        Key key;
        Block block;
    };
    struct Loading { // one block on its way; under mutex_
        bool isOver = false;
        Block block;
        std::optional<Error> error;
    };
    using LoadingPtr = std::shared_ptr<Loading>;
    class Claim;

    Block findLocked(const Key& key);
    void keepLocked(const Key& key, Block block);
    Result<Block> await(const File& file, std::uint64_t index, const LoadingPtr& loading, const Fetch& fetch,
                        const std::atomic<bool>& stop);

    const std::uint64_t maxBytes_;
    mutable std::mutex mutex_;
    std::condition_variable over_; // a block has come, or failed
    std::list<Entry> entries_;     // most recently used first
    std::unordered_map<Key, std::list<Entry>::iterator, KeyHash> places_;
    std::unordered_map<Key, LoadingPtr, KeyHash> loading_;
    CacheCounts counts_;
};

} // namespace stipple::server
