#include "converter/build/parallel.hpp"

#include <algorithm>
#include <mutex>
#include <new>
#include <optional>
#include <thread>
#include <vector>

namespace stipple {

int threadCount(int requested) {
    if (requested > 0)
        return requested;
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

namespace {
struct SharedState {
    std::atomic<std::size_t> next{0};
    std::atomic<bool> failed{false};
    std::mutex mutex;
    std::size_t errorIndex = 0;
    std::optional<Error> error;

    void fail(std::size_t index, Error why) {
        std::lock_guard lock(mutex);
        if (!error || index < errorIndex) {
            errorIndex = index;
            error = std::move(why);
        }
        failed = true;
    }
};

Status runTask(const std::function<Status(std::size_t, int)>& task, std::size_t index, int worker) {
    try {
        return task(index, worker);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::limitExceeded, "there is not enough memory", "",
                     "use a machine with more memory, or fewer inputs"};
    }
}
} // namespace

Status parallelFor(std::size_t count, int threads, const std::atomic<bool>* stop,
                   const std::function<Status(std::size_t index, int worker)>& task) {
    SharedState state;
    auto work = [&](int worker) {
        for (;;) {
            std::size_t index = state.next.fetch_add(1);
            if (index >= count || state.failed)
                return;
            if (stop && *stop) {
                state.fail(index, Error{ErrorCode::cancelled, "interrupted", "", ""});
                return;
            }
            if (Status done = runTask(task, index, worker); !done)
                state.fail(index, done.error());
        }
    };
    std::size_t wanted = std::min<std::size_t>(count, static_cast<std::size_t>(std::max(1, threads)));
    std::vector<std::thread> helpers;
    for (std::size_t t = 1; t < wanted; ++t)
        helpers.emplace_back(work, static_cast<int>(t));
    work(0);
    for (std::thread& helper : helpers)
        helper.join();
    if (state.error)
        return *state.error;
    return {};
}

} // namespace stipple
