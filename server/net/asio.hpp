// The Asio types that server/net uses: bound to io_context's own executor, because the type-erased one costs
// a few hundred nanoseconds a request. Internal to server/net.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/basic_stream_socket.hpp>
#include <boost/asio/basic_waitable_timer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <chrono>

namespace stipple::server {

namespace net = boost::asio;
using Tcp = net::ip::tcp;
using Executor = net::io_context::executor_type;
using Socket = net::basic_stream_socket<Tcp, Executor>;
using Acceptor = net::basic_socket_acceptor<Tcp, Executor>;
using Timer = net::basic_waitable_timer<std::chrono::steady_clock,
                                        net::wait_traits<std::chrono::steady_clock>, Executor>;
using Failure = boost::system::error_code;

template <class T>
using Task = net::awaitable<T, Executor>;

// co_await gives a tuple that begins with the error; nothing throws.
inline constexpr auto answered = net::as_tuple(net::use_awaitable_t<Executor>());

} // namespace stipple::server
