// The threads that jobs run on, and the queue before them. Fair between clients: those with work waiting take
// turns, and none may run more than half of what may run at once, so a newcomer never waits behind all of
// one client's work. Thread: any.
#pragma once

#include "server/jobs/job_run.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace stipple::server {

struct JobLimits {
    int working = 0;                         // jobs that compute at once; 0: one for each core, 2 to 8
    int queued = 64;                         // jobs of all clients that may wait; more: 503
    int perClient = 8;                       // jobs of one client, waiting or running; more: 429
    std::chrono::milliseconds work{60'000};  // that a job may compute; waiting for its client is not counted
    std::chrono::milliseconds queue{30'000}; // that a job may wait for its turn; longer: 503
};

struct JobCounts {
    int running = 0, queued = 0;
    std::uint64_t accepted = 0, refused = 0, cancelled = 0;
};

class JobPool {
  public:
    enum class Admission { accepted, clientIsBusy, isFull };

    explicit JobPool(const JobLimits& limits);
    ~JobPool(); // end()
    JobPool(const JobPool&) = delete;
    JobPool& operator=(const JobPool&) = delete;

    // `client`: whom the limits count it for.
    Admission submit(const std::string& client, std::shared_ptr<JobRun> run);
    // Nobody takes the answer any more: stops the job, or drops it from the queue.
    void withdraw(const std::shared_ptr<JobRun>& run);
    // Stops what is left and waits for it; nothing is accepted afterwards.
    void end();

    JobCounts counts() const;
    const JobLimits& limits() const { return limits_; }

  private:
    struct Client {
        std::deque<std::shared_ptr<JobRun>> queue;
        int running = 0;
    };
    void work();
    std::shared_ptr<JobRun> next(std::string& client); // null: none may start now
    void ended(const std::string& client);
    void waits(bool begins);
    void startThreadIfNeeded();
    bool mayStart() const;

    JobLimits limits_;
    int maxRunning_, maxRunningPerClient_;
    mutable std::mutex mutex_;
    std::condition_variable wake_;
    std::map<std::string, Client> clients_; // those with jobs
    std::deque<std::string> turns_;         // clients with jobs waiting, the next one first
    std::vector<std::shared_ptr<JobRun>> running_;
    std::vector<std::thread> threads_;
    int idleThreads_ = 0;
    int waiting_ = 0; // of running_: held back by their clients; they compute nothing
    JobCounts counts_;
    bool isEnding_ = false;
};

} // namespace stipple::server
