#include "server/net/loop.hpp"

#include "server/net/connection.hpp"

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>

namespace stipple::server {

Loop::Loop(ServerState& state) : state_(state), work_(context_.get_executor()), sweepTimer_(context_) {
    scheduleSweep();
    thread_ = std::thread([this] { context_.run(); });
}

Loop::~Loop() = default;

void Loop::adopt(Socket socket, std::string countedFor) {
    auto connection = std::make_unique<Connection>(*this, std::move(socket), state_.tls());
    connections_.insert(connection.get());
    net::co_spawn(context_, serve(std::move(connection), std::move(countedFor)), net::detached);
}

Task<void> Loop::serve(std::unique_ptr<Connection> connection, std::string countedFor) {
    co_await connection->run();
    connections_.erase(connection.get());
    connection.reset(); // its descriptor is free before another client is let in
    state_.connections.remove(countedFor);
}

void Loop::closeIdle(std::chrono::milliseconds atLeast) {
    net::post(context_, [this, before = Connection::Clock::now() - atLeast] {
        closeEach([before](const Connection& connection) { return connection.isIdleSince(before); });
    });
}

void Loop::stop() {
    net::post(context_, [this] {
        isStopping_ = true;
        closeEach([](const Connection& connection) { return connection.isIdle(); });
    });
}

void Loop::cut() {
    net::post(context_, [this] { closeEach([](const Connection&) { return true; }); });
}

void Loop::join() {
    work_.reset();
    context_.stop();
    if (thread_.joinable())
        thread_.join();
}

void Loop::closeEach(const std::function<bool(const Connection&)>& which) {
    for (Connection* connection : connections_)
        if (which(*connection))
            connection->close();
}

void Loop::scheduleSweep() {
    sweepTimer_.expires_after(state_.limits.sweep);
    sweepTimer_.async_wait([this](const Failure& error) {
        if (error)
            return;
        auto now = Connection::Clock::now();
        closeEach([now](const Connection& connection) { return connection.isLate(now); });
        scheduleSweep();
    });
}

} // namespace stipple::server
