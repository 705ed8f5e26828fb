#include "client/render/worker_pool.hpp"

#include <algorithm>

namespace stipple {

WorkerPool::WorkerPool(int threads) {
    int wanted = threads > 0 ? threads : static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    for (int i = 1; i < wanted; ++i)
        helpers_.emplace_back([this] { help(); });
}

WorkerPool::~WorkerPool() {
    {
        std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    for (std::thread& helper : helpers_)
        helper.join();
}

void WorkerPool::takePieces(const std::function<void(std::size_t)>& piece, std::size_t count) {
    for (std::size_t i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < count;)
        piece(i);
}

void WorkerPool::run(std::size_t count, const std::function<void(std::size_t)>& piece) {
    if (helpers_.empty() || count < 2) {
        for (std::size_t i = 0; i < count; ++i)
            piece(i);
        return;
    }
    {
        std::lock_guard lock(mutex_);
        piece_ = &piece;
        count_ = count;
        next_.store(0, std::memory_order_relaxed);
        busy_ = helpers_.size();
        ++task_;
    }
    wake_.notify_all();
    takePieces(piece, count);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
}

void WorkerPool::help() {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [&] { return stopping_ || task_ != seen; });
        if (stopping_)
            return;
        seen = task_;
        const auto* piece = piece_;
        std::size_t count = count_;
        lock.unlock();
        takePieces(*piece, count);
        lock.lock();
        if (--busy_ == 0)
            done_.notify_one();
    }
}

} // namespace stipple
