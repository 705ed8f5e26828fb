#include "server/jobs/job_pool.hpp"

#include <algorithm>
#include <system_error>

namespace stipple::server {

namespace {
// A job that waits for a slow client needs a thread but no core, so there are more threads than may compute.
constexpr int threadsForEachWorking = 4;
} // namespace

JobPool::JobPool(const JobLimits& limits) : limits_(limits) {
    if (limits_.working <= 0)
        limits_.working = std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 2, 8);
    maxRunning_ = limits_.working * threadsForEachWorking;
    maxRunningPerClient_ = (limits_.working + 1) / 2;
}

JobPool::~JobPool() {
    end();
}

void JobPool::end() {
    std::vector<std::shared_ptr<JobRun>> running;
    std::vector<std::thread> threads;
    std::map<std::string, Client> dropped; // destroyed outside the lock
    {
        std::lock_guard lock(mutex_);
        isEnding_ = true;
        running = running_;
        threads.swap(threads_);
        turns_.clear();
        for (auto& [name, client] : clients_)
            dropped[name].queue.swap(client.queue);
        counts_.queued = 0;
        wake_.notify_all();
    }
    for (auto& run : running)
        run->stop();
    for (std::thread& thread : threads)
        thread.join();
}

JobPool::Admission JobPool::submit(const std::string& client, std::shared_ptr<JobRun> run) {
    std::lock_guard lock(mutex_);
    auto found = clients_.find(client);
    int already =
        found == clients_.end() ? 0 : found->second.running + static_cast<int>(found->second.queue.size());
    if (already < limits_.perClient && counts_.queued < limits_.queued && !isEnding_)
        startThreadIfNeeded();
    if (already >= limits_.perClient || counts_.queued >= limits_.queued || threads_.empty()) {
        ++counts_.refused;
        return already >= limits_.perClient ? Admission::clientIsBusy : Admission::isFull;
    }
    Client& entry = clients_[client];
    if (entry.queue.empty())
        turns_.push_back(client);
    entry.queue.push_back(std::move(run));
    ++counts_.queued;
    ++counts_.accepted;
    wake_.notify_one();
    return Admission::accepted;
}

bool JobPool::mayStart() const {
    int running = static_cast<int>(running_.size());
    return !isEnding_ && running < maxRunning_ && running - waiting_ < limits_.working;
}

void JobPool::startThreadIfNeeded() {
    if (idleThreads_ > 0 || static_cast<int>(threads_.size()) >= maxRunning_ || !mayStart())
        return;
    try {
        threads_.emplace_back([this] { work(); });
    } catch (const std::system_error&) {
        // The system grants no more threads: those that there are do the work. Without any, submit() refuses.
    }
}

void JobPool::withdraw(const std::shared_ptr<JobRun>& run) {
    run->stop();
    std::lock_guard lock(mutex_);
    ++counts_.cancelled;
    for (auto turn = turns_.begin(); turn != turns_.end(); ++turn) {
        auto entry = clients_.find(*turn);
        auto& queue = entry->second.queue;
        auto found = std::find(queue.begin(), queue.end(), run);
        if (found == queue.end())
            continue;
        queue.erase(found);
        --counts_.queued;
        if (queue.empty()) {
            if (entry->second.running == 0)
                clients_.erase(entry);
            turns_.erase(turn);
        }
        return;
    }
}

JobCounts JobPool::counts() const {
    std::lock_guard lock(mutex_);
    JobCounts counts = counts_;
    counts.running = static_cast<int>(running_.size());
    return counts;
}

void JobPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        std::string client;
        std::shared_ptr<JobRun> run;
        ++idleThreads_;
        wake_.wait(lock, [&] { return isEnding_ || (run = next(client)) != nullptr; });
        --idleThreads_;
        if (run == nullptr)
            return;
        if (!turns_.empty())
            startThreadIfNeeded();
        lock.unlock();
        run->run([this](bool begins) { waits(begins); });
        lock.lock();
        running_.erase(std::find(running_.begin(), running_.end(), run));
        ended(client);
    }
}

// Under the lock. Whose turn it is, unless it has its share.
std::shared_ptr<JobRun> JobPool::next(std::string& client) {
    if (!mayStart())
        return nullptr;
    for (auto turn = turns_.begin(); turn != turns_.end(); ++turn) {
        Client& entry = clients_[*turn];
        if (entry.running >= maxRunningPerClient_)
            continue;
        client = *turn;
        std::shared_ptr<JobRun> run = std::move(entry.queue.front());
        entry.queue.pop_front();
        turns_.erase(turn);
        if (!entry.queue.empty())
            turns_.push_back(client);
        --counts_.queued;
        ++entry.running;
        running_.push_back(run);
        return run;
    }
    return nullptr;
}

void JobPool::ended(const std::string& client) {
    auto found = clients_.find(client);
    if (found != clients_.end() && --found->second.running == 0 && found->second.queue.empty())
        clients_.erase(found);
    wake_.notify_all();
}

void JobPool::waits(bool begins) {
    std::lock_guard lock(mutex_);
    waiting_ += begins ? 1 : -1;
    if (begins && !turns_.empty()) {
        startThreadIfNeeded();
        wake_.notify_one();
    }
}

} // namespace stipple::server
