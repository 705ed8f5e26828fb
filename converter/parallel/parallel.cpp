#include "converter/parallel/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>

namespace stipple {

int threadCount(int requested) {
    if (requested > 0)
        return requested;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

Error outOfMemory() {
    return {ErrorCode::outOfMemory, "there is not enough memory", "",
            "allow less with --memory, or use fewer threads"};
}

std::vector<std::thread> startThreads(std::size_t count, const std::function<void(std::size_t)>& run) {
    std::vector<std::thread> threads;
    threads.reserve(count);
    // A thread needs a stack. Those that have begun must not be left alone: nothing may be thrown from here
    // on.
    try {
        for (std::size_t i = 0; i < count; ++i)
            threads.emplace_back([run, i] { run(i); });
    } catch (const std::system_error&) {
    } catch (const std::bad_alloc&) {
    }
    return threads;
}

namespace {
struct SharedState {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false}, outOfMemory{false};
    std::mutex mutex;
    std::size_t errorIndex = 0;
    std::optional<Error> error;

    void fail(std::size_t index, const Error& why) {
        std::lock_guard lock(mutex);
        if (!error || index < errorIndex) {
            errorIndex = index;
            error = why;
        }
        failed = true;
    }
};

// Notes what came of a task; where memory has run out, without asking for any.
template <class Work>
void attempt(SharedState& state, std::size_t index, Work work) {
    try {
        if (Status done = work(); !done)
            state.fail(index, done.error());
    } catch (const std::bad_alloc&) {
        state.outOfMemory = true;
        state.failed = true;
    }
}
} // namespace

Status parallelFor(std::size_t count, int threads, const std::atomic<bool>* stop,
                   const std::function<Status(std::size_t index, int worker)>& task) {
    SharedState state;
    auto runTask = [&](std::size_t index, int worker) -> Status {
        if (stop && *stop)
            return Error{ErrorCode::cancelled, "interrupted", "", ""};
        return task(index, worker);
    };
    auto work = [&](int worker) {
        for (;;) {
            std::size_t index = state.next.fetch_add(1);
            if (index >= count || state.failed)
                return;
            attempt(state, index, [&] { return runTask(index, worker); });
        }
    };
    std::size_t wanted = std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)));
    std::vector<std::thread> helpers =
        startThreads(wanted > 1 ? wanted - 1 : 0, [&](std::size_t i) { work(static_cast<int>(i) + 1); });
    work(0);
    for (std::thread& helper : helpers)
        helper.join();
    if (state.error)
        return *state.error;
    if (state.outOfMemory)
        return outOfMemory();
    return {};
}

} // namespace stipple
