#include "server/net/signals.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <csignal>

namespace stipple::server {

namespace net = boost::asio;

void runUntilSignalled(Server& server, std::chrono::milliseconds grace) {
    constexpr std::chrono::milliseconds glance{20}, cutLimit{2000};
    net::io_context context(1);
    net::signal_set signals(context, SIGINT, SIGTERM);
    bool isStopping = false, isCut = false;
    auto wait = [&](auto&& self) -> void {
        signals.async_wait([&, self](const boost::system::error_code& error, int) {
            if (error)
                return;
            (isStopping ? isCut : isStopping) = true;
            self(self);
        });
    };
    wait(wait);

    while (!isStopping)
        context.run_one();
    server.stop();
    auto end = std::chrono::steady_clock::now() + grace;
    while (!isCut && !server.waitUntilDrained(glance) && std::chrono::steady_clock::now() < end)
        context.poll();
    server.cut();
    server.waitUntilDrained(cutLimit);
}

} // namespace stipple::server
