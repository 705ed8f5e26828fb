#include "client/reference/node_reader.hpp"

#include <condition_variable>
#include <deque>
#include <mutex>
#include <optional>
#include <thread>

namespace stipple::reference {
namespace {

struct Work {
    NodeBytes bytes;
    std::uint64_t firstOrder = 0;
};

// Nodes that are read and not yet decoded: at most `limit`.
class WorkQueue {
  public:
    explicit WorkQueue(std::size_t limit) : limit_(limit) {}

    // Waits for room. False: someone failed, no more is wanted.
    bool put(Work work) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waiting_.size() < limit_ || error_; });
        if (error_)
            return false;
        waiting_.push_back(std::move(work));
        changed_.notify_all();
        return true;
    }
    // Waits for work; none once closed and empty, or failed.
    std::optional<Work> take() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !waiting_.empty() || closed_ || error_; });
        if (waiting_.empty() || error_)
            return std::nullopt;
        Work work = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        return work;
    }
    void close() {
        std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }
    void fail(const Error& error) {
        std::lock_guard lock(mutex_);
        if (!error_)
            error_ = error;
        changed_.notify_all();
    }
    Status status() {
        std::lock_guard lock(mutex_);
        return error_ ? Status(*error_) : Status();
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Work> waiting_;
    std::size_t limit_;
    bool closed_ = false;
    std::optional<Error> error_;
};

Status readAll(CloudReader& reader, std::span<const int> attributes, WorkQueue& queue) {
    std::uint64_t order = 0;
    return reader.visitNodes([&](const NodeEntry& entry) -> Status {
        if (entry.pointCount == 0)
            return {};
        STIPPLE_TRY(bytes, reader.fetchNode(entry, attributes));
        if (!queue.put({std::move(bytes), order}))
            return queue.status();
        order += entry.pointCount;
        return {};
    });
}

} // namespace

Status visitPoints(CloudReader& reader, std::span<const int> attributes, int threads,
                   const std::function<void(const NodeKey& key, const PointBatch& points,
                                            std::uint64_t firstOrder)>& visit) {
    WorkQueue queue(2 * static_cast<std::size_t>(threads));
    const CloudMetadata& metadata = reader.metadata();
    std::vector<std::jthread> decoders;
    for (int i = 0; i < threads; ++i)
        decoders.emplace_back([&] {
            while (std::optional<Work> work = queue.take()) {
                auto points = decodeNode(metadata, work->bytes);
                if (points.ok())
                    visit(work->bytes.entry.key, *points, work->firstOrder);
                else
                    queue.fail(points.error());
            }
        });
    Status read = readAll(reader, attributes, queue);
    if (read.ok())
        queue.close();
    else
        queue.fail(read.error());
    decoders.clear(); // waits
    return queue.status();
}

} // namespace stipple::reference
