#include "server/net/signals.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>

namespace stipple::server {

namespace net = boost::asio;

struct StopSignals::State {
    net::io_context context{1};
    net::signal_set signals{context, SIGINT, SIGTERM};
    int received = 0;

    void wait() {
        signals.async_wait([this](const boost::system::error_code& error, int) {
            if (error)
                return;
            ++received;
            wait();
        });
    }
};

StopSignals::StopSignals() : state_(std::make_unique<State>()) {
    state_->wait();
}

StopSignals::~StopSignals() = default;

void StopSignals::runUntilSignalled(Server& server, std::chrono::milliseconds grace) {
    constexpr std::chrono::milliseconds glance{20}, cutLimit{2000};
    while (state_->received == 0)
        state_->context.run_one();
    server.stop();
    auto end = std::chrono::steady_clock::now() + grace;
    while (state_->received < 2 && !server.waitUntilDrained(glance) && std::chrono::steady_clock::now() < end)
        state_->context.poll();
    server.cut();
    server.waitUntilDrained(cutLimit);
}

} // namespace stipple::server
