// Independent tasks on a few threads.
#pragma once

#include "shared/base/result.hpp"

#include <atomic>
#include <cstddef>
#include <functional>
#include <thread>
#include <vector>

namespace stipple {

// `requested` threads, or one for each core if that is 0 or less.
int threadCount(int requested);

// Runs task(0) … task(count - 1), each once, on up to `threads` threads, and returns when all are done. After
// an error no further task is started; the error of the lowest index is returned. Running out of memory
// in a task is outOfMemory; `stop` turning true is cancelled. `worker` is in [0, threads).
Status parallelFor(std::size_t count, int threads, const std::atomic<bool>* stop,
                   const std::function<Status(std::size_t index, int worker)>& task);

// What running out of memory (std::bad_alloc) is told as.
Error outOfMemory();

// Threads that run(0), run(1), … run(count - 1); fewer if the system has no room for so many.
std::vector<std::thread> startThreads(std::size_t count, const std::function<void(std::size_t)>& run);

} // namespace stipple
