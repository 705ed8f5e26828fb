// Values that are made once and used by many: hierarchy chunks, blocks of an upstream, pictures. Bounded by
// bytes, the least recently used leave first; a value that several threads want at once is made by one of
// them while the others wait. Thread: any.
#pragma once

#include "shared/base/result.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <optional>
#include <unordered_map>
#include <utility>

namespace stipple::server {

struct CacheCounts {
    std::uint64_t hits = 0, misses = 0;
    std::uint64_t waits = 0;   // misses that waited for another thread's making
    std::uint64_t evicted = 0; // values that left for others
    std::uint64_t bytes = 0;   // held now
};

template <class Key, class Value, class Hash = std::hash<Key>>
class SharedCache {
  public:
    using ValuePtr = std::shared_ptr<const Value>;
    struct Made {
        ValuePtr value;
        std::uint64_t bytes = 0; // that it counts for
    };
    using Make = std::function<Result<Made>()>;

    // A value larger than `maxBytes` is handed out but not kept.
    explicit SharedCache(std::uint64_t maxBytes) : maxBytes_(maxBytes) {}

    // Null if it is not there; doesn't wait.
    ValuePtr find(const Key& key) {
        std::lock_guard lock(mutex_);
        ValuePtr value = findLocked(key);
        counts_.hits += value != nullptr;
        return value;
    }

    // The value, made by `make` (without any lock held) if it is not there. Errors are not kept: whoever
    // waited for the failed making gets the same one, later callers make anew. If the maker was `cancelled`,
    // which is its own affair, one of those that wait takes over. `stop`: ends the waiting with `cancelled`.
    Result<ValuePtr> get(const Key& key, const Make& make, const std::atomic<bool>& stop) {
        std::unique_lock lock(mutex_);
        for (bool hasWaited = false;;) {
            if (ValuePtr value = findLocked(key)) {
                hasWaited ? ++counts_.waits : ++counts_.hits;
                return value;
            }
            auto making = making_.find(key);
            if (making == making_.end())
                break;
            std::shared_ptr<Making> other = making->second;
            hasWaited = true;
            if (!waitFor(*other, lock, stop))
                return Error{ErrorCode::cancelled, "the request was taken back", "", ""};
            if (other->value) // handed out even if it was too large to keep
                return other->value;
            if (other->error && other->error->code != ErrorCode::cancelled)
                return *other->error;
        }
        ++counts_.misses;
        Turn turn(*this, key);
        lock.unlock();
        Result<Made> made = make();
        if (!made)
            return turn.fail(made.error());
        return turn.succeed(std::move(*made));
    }

    CacheCounts counts() const {
        std::lock_guard lock(mutex_);
        return counts_;
    }

  private:
    struct Entry {
        Key key;
        ValuePtr value;
        std::uint64_t bytes;
    };
    struct Making {
        bool isOver = false;
        ValuePtr value;
        std::optional<Error> error;
    };

    // One making. However it ends, also by an exception, those that wait go on.
    class Turn {
      public:
        Turn(SharedCache& cache, const Key& key) : cache_(cache), key_(key) { // locked
            cache_.making_[key_] = making_;
        }
        ~Turn() {
            std::lock_guard lock(cache_.mutex_);
            if (kept_)
                cache_.keep(key_, making_->value, *kept_);
            cache_.making_.erase(key_);
            making_->isOver = true;
            cache_.over_.notify_all();
        }
        Turn(const Turn&) = delete;
        Turn& operator=(const Turn&) = delete;

        Error fail(Error error) {
            making_->error = error;
            return error;
        }
        ValuePtr succeed(Made made) {
            kept_ = made.bytes;
            return making_->value = std::move(made.value);
        }

      private:
        SharedCache& cache_;
        const Key key_;
        std::shared_ptr<Making> making_ = std::make_shared<Making>();
        std::optional<std::uint64_t> kept_;
    };

    ValuePtr findLocked(const Key& key) {
        auto found = places_.find(key);
        if (found == places_.end())
            return nullptr;
        entries_.splice(entries_.begin(), entries_, found->second);
        return found->second->value;
    }

    bool waitFor(const Making& other, std::unique_lock<std::mutex>& lock, const std::atomic<bool>& stop) {
        constexpr std::chrono::milliseconds untilLookingAtStop{20};
        while (!other.isOver && !stop)
            over_.wait_for(lock, untilLookingAtStop);
        return other.isOver;
    }

    void keep(const Key& key, ValuePtr value, std::uint64_t bytes) {
        if (bytes > maxBytes_)
            return;
        entries_.push_front({key, std::move(value), bytes});
        places_[key] = entries_.begin();
        for (counts_.bytes += bytes; counts_.bytes > maxBytes_; ++counts_.evicted) {
            counts_.bytes -= entries_.back().bytes;
            places_.erase(entries_.back().key);
            entries_.pop_back();
        }
    }

    const std::uint64_t maxBytes_;
    mutable std::mutex mutex_;
    std::condition_variable over_; // a making is over
    std::list<Entry> entries_;     // most recently used first
    std::unordered_map<Key, typename std::list<Entry>::iterator, Hash> places_;
    std::unordered_map<Key, std::shared_ptr<Making>, Hash> making_;
    CacheCounts counts_;
};

} // namespace stipple::server
