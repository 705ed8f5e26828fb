// One thread's event loop: its connections, its buffers, and the sweep that closes those over their time.
// Internal to server/net.
#pragma once

#include "server/net/asio.hpp"
#include "server/net/connection_count.hpp"
#include "server/net/request_metrics.hpp"
#include "server/net/response_sender.hpp"
#include "server/net/server.hpp"

#include <atomic>
#include <boost/asio/executor_work_guard.hpp>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace stipple::server {

// What all loops share.
struct ServerState {
    explicit ServerState(const ServerLimits& chosen)
        : limits(chosen), jobs(chosen.jobs), transfers(chosen.transfers) {}

    ServerLimits limits;
    std::shared_ptr<const RequestHandler> handler;
    RequestLog log;
    JobPool jobs, transfers;
    JobPool& poolOf(const JobRun& run) { return run.isTransfer() ? transfers : jobs; }
    // Of connections to come; null: plain.
    std::shared_ptr<const TlsContext> tls() {
        std::lock_guard lock(tlsMutex);
        return tlsContext;
    }
    std::mutex tlsMutex;
    std::shared_ptr<const TlsContext> tlsContext;
    ConnectionCount connections;
    std::vector<net::ip::address> trustedProxies;
    std::vector<const RequestMetrics*> metrics; // one of each loop; complete before any runs
    MetricsFor metricsFor = MetricsFor::nobody;
    std::atomic<bool> isEnding{false}; // every answer is the last of its connection
};

class Connection;

class Loop {
  public:
    explicit Loop(ServerState& state);
    ~Loop(); // after join()

    net::io_context& context() { return context_; }
    ServerState& state() { return state_; }

    // From any thread.
    void closeIdle(std::chrono::milliseconds atLeast); // those that have been idle for that long
    void stop();
    void cut();
    void join(); // ends the loop, dropping what is left

    // From the loop's own thread.
    void adopt(Socket socket, std::string countedFor); // a group of ServerState::connections; empty: none
    bool isStopping() const { return isStopping_; }
    BufferPool& buffers() { return buffers_; }
    RequestMetrics& metrics() { return metrics_; } // its totals: from any thread

  private:
    Task<void> serve(std::unique_ptr<Connection> connection, std::string countedFor);
    void scheduleSweep();
    void closeEach(const std::function<bool(const Connection&)>& which);

    ServerState& state_;
    net::io_context context_{1};
    net::executor_work_guard<Executor> work_;
    Timer sweepTimer_;
    std::set<Connection*> connections_;
    BufferPool buffers_;
    RequestMetrics metrics_;
    bool isStopping_ = false;
    std::thread thread_;
};

} // namespace stipple::server
