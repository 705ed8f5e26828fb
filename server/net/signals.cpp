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

void ServerSignals::runUntilSignalled(Server& server, std::chrono::milliseconds notice,
                                      std::chrono::milliseconds grace, const std::function<void()>& reload) {
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
    server.announceEnd();
    auto now = [] { return std::chrono::steady_clock::now(); };
    for (auto end = now() + notice; state_->received < 2 && now() < end;)
        state_->context.run_one_until(end);
    server.stop();
    for (auto end = now() + grace; state_->received < 2 && !server.waitUntilDrained(glance) && now() < end;)
        state_->context.poll();
    server.cut();
    server.waitUntilDrained(cutLimit);
}

} // namespace stipple::server
