// One thread's event loop: its connections, its buffers, and the sweep that closes those over their time.
// Internal to server/net.
#pragma once

#include "server/net/server.hpp"

#include <atomic>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

namespace stipple::server {

// What all loops share.
struct ServerState {
    explicit ServerState(const ServerLimits& chosen) : limits(chosen), jobs(chosen.jobs) {}

    ServerLimits limits;
    std::shared_ptr<const RequestHandler> handler;
    RequestLog log;
    JobPool jobs;
    std::mutex logMutex;
    std::atomic<int> openConnections{0};
    std::mutex drainedMutex;
    std::condition_variable drained; // notified when a connection ends
};

class Connection;

class Loop {
  public:
    explicit Loop(ServerState& state);
    ~Loop(); // after join()

    boost::asio::io_context& context() { return context_; }
    ServerState& state() { return state_; }

    // From any thread.
    void stop();
    void cut();
    void join(); // ends the loop, dropping what is left

    // From the loop's own thread.
    void adopt(boost::asio::ip::tcp::socket socket); // counted in openConnections already
    bool isStopping() const { return isStopping_; }
    std::vector<char> takeBuffer(); // bufferBytes long
    void giveBuffer(std::vector<char> buffer);

    static constexpr std::size_t bufferBytes = 64 * 1024;

  private:
    boost::asio::awaitable<void> serve(std::unique_ptr<Connection> connection);
    void release(Connection& connection);
    void scheduleSweep();
    void closeEach(const std::function<bool(const Connection&)>& which);

    ServerState& state_;
    boost::asio::io_context context_{1};
    boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_;
    boost::asio::steady_timer sweepTimer_;
    std::set<Connection*> connections_;
    std::vector<std::vector<char>> spareBuffers_;
    bool isStopping_ = false;
    std::thread thread_;
};

} // namespace stipple::server
