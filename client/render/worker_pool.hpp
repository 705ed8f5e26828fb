// Threads that share out the pieces of one task at a time: the caller and `threads - 1` helpers, which sleep
// in between.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace stipple {

class WorkerPool {
  public:
    explicit WorkerPool(int threads); // 0: one per core
    ~WorkerPool();
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    // Calls piece(i) once for every i in [0, count), in any order and on any of the threads; returns when
    // all are done. Called by one thread at a time; `piece` must not throw.
    void run(std::size_t count, const std::function<void(std::size_t)>& piece);

    int threads() const { return static_cast<int>(helpers_.size()) + 1; }

  private:
    void help();
    void takePieces(const std::function<void(std::size_t)>& piece, std::size_t count);

    std::vector<std::thread> helpers_;
    std::mutex mutex_;
    std::condition_variable wake_, done_;
    const std::function<void(std::size_t)>* piece_ = nullptr;
    std::size_t count_ = 0;
    std::atomic<std::size_t> next_{0};
    std::size_t busy_ = 0;   // helpers that have not finished the current task
    std::uint64_t task_ = 0; // number of the current task
    bool stopping_ = false;
};

} // namespace stipple
