#include "server/net/signals.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <utility>

namespace stipple::server {

namespace net = boost::asio;

struct ServerSignals::State {
    net::io_context context{1};
    net::signal_set signals{context, SIGINT, SIGTERM, SIGHUP};
    int received = 0; // that ask for the end
    bool asksForReload = false;

    void wait() {
        signals.async_wait([this](const boost::system::error_code& error, int number) {
            if (error)
                return;
            if (number == SIGHUP)
                asksForReload = true;
            else
                ++received;
            wait();
        });
    }
};

ServerSignals::ServerSignals() : state_(std::make_unique<State>()) {
    state_->wait();
}

ServerSignals::~ServerSignals() = default;

void ServerSignals::runUntilSignalled(Server& server, std::chrono::milliseconds grace,
                                      const std::function<void()>& reload) {
    constexpr std::chrono::milliseconds glance{20}, cutLimit{2000};
    while (state_->received == 0) {
        state_->context.run_one();
        if (!std::exchange(state_->asksForReload, false))
            continue;
        if (reload)
            reload();
        else
            ++state_->received;
    }
    server.stop();
    auto end = std::chrono::steady_clock::now() + grace;
    while (state_->received < 2 && !server.waitUntilDrained(glance) && std::chrono::steady_clock::now() < end)
        state_->context.poll();
    server.cut();
    server.waitUntilDrained(cutLimit);
}

} // namespace stipple::server
