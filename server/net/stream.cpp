#include "server/net/stream.hpp"

#include <algorithm>
#include <cerrno>
#include <limits>
#include <netinet/tcp.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sys/socket.h>

namespace stipple::server {

namespace {

// Bytes that wait in the kernel for a client that is behind, beside those that are under way to it. Without
// this limit it is what tcp_wmem allows, 4 MiB, and a thousand clients that don't read exhaust the memory for
// TCP of all. With more, those that are ahead go on being so, and the slowest answers take longer.
constexpr int mostUnsentBytes = 64 * 1024;
constexpr unsigned char tlsHandshakeRecord = 0x16; // RFC 8446 §5.1

Moved movedOr(ssize_t moved, Wait whenFull) {
    if (moved > 0)
        return {static_cast<std::size_t>(moved), Wait::nothing};
    if (moved < 0 && errno == EAGAIN)
        return {0, whenFull};
    if (moved < 0 && errno == EINTR)
        return {0, Wait::nothing};
    return {0, Wait::never};
}

} // namespace

Stream::Stream(Socket socket, std::shared_ptr<const TlsContext> tls)
    : socket_(std::move(socket)), tls_(std::move(tls)) {
    Failure ignored;
    socket_.set_option(Tcp::no_delay(true), ignored);
    socket_.set_option(net::detail::socket_option::integer<IPPROTO_TCP, TCP_NOTSENT_LOWAT>(mostUnsentBytes),
                       ignored);
    socket_.native_non_blocking(true, ignored);
    socket_.non_blocking(true, ignored);
}

Stream::~Stream() {
    SSL_free(session_);
}

Task<bool> Stream::open() {
    if (!tls_)
        co_return true;
    bool isReadable = co_await wait(Wait::readable);
    if (!isReadable)
        co_return false;
    unsigned char first = 0;
    if (::recv(socket_.native_handle(), &first, 1, MSG_PEEK) == 1 && first != tlsHandshakeRecord) {
        spokePlainly_ = true;
        co_return true;
    }
    session_ = tls_->newSession();
    if (session_ == nullptr || SSL_set_fd(session_, socket_.native_handle()) != 1)
        co_return false;
    for (;;) {
        ERR_clear_error();
        int result = SSL_do_handshake(session_);
        if (result == 1)
            co_return true;
        bool goesOn = co_await wait(waitAfter(result));
        if (!goesOn)
            co_return false;
    }
}

// Of OpenSSL's last call on the session. After a failure nothing more may be done with it, not even to say
// goodbye (SSL_get_error(3)).
Wait Stream::waitAfter(int result) {
    switch (SSL_get_error(session_, result)) {
    case SSL_ERROR_WANT_READ:
        return Wait::readable;
    case SSL_ERROR_WANT_WRITE:
        return Wait::writable;
    case SSL_ERROR_ZERO_RETURN:
        return Wait::never;
    default:
        isBroken_ = true;
        return Wait::never;
    }
}

Task<std::size_t> Stream::readSome(char* to, std::size_t size) {
    if (session_ == nullptr) {
        auto [error, count] = co_await socket_.async_read_some(net::buffer(to, size), answered);
        co_return error ? 0 : count;
    }
    for (;;) {
        if (!socket_.is_open() || isBroken_)
            co_return 0;
        ERR_clear_error();
        std::size_t count = 0;
        int result = SSL_read_ex(session_, to, size, &count);
        if (result == 1)
            co_return count;
        bool goesOn = co_await wait(waitAfter(result));
        if (!goesOn)
            co_return 0;
    }
}

Moved Stream::write(std::string_view bytes) {
    if (!socket_.is_open() || isBroken_)
        return {0, Wait::never};
    if (session_ == nullptr)
        return movedOr(::send(socket_.native_handle(), bytes.data(), bytes.size(), MSG_NOSIGNAL),
                       Wait::writable);
    ERR_clear_error();
    std::size_t count = 0;
    int result = SSL_write_ex(session_, bytes.data(), bytes.size(), &count);
    return result == 1 ? Moved{count, Wait::nothing} : Moved{0, waitAfter(result)};
}

Task<bool> Stream::wait(Wait what) {
    if (what == Wait::never || !socket_.is_open())
        co_return false;
    auto [error] = co_await socket_.async_wait(
        what == Wait::writable ? Socket::wait_write : Socket::wait_read, answered);
    co_return !error;
}

Task<bool> Stream::writeAll(std::string_view bytes) {
    while (!bytes.empty()) {
        Moved moved = write(bytes);
        bytes.remove_prefix(moved.bytes);
        if (moved.wait == Wait::nothing)
            continue;
        bool goesOn = co_await wait(moved.wait);
        if (!goesOn)
            co_return false;
    }
    co_return true;
}

net::ip::address Stream::peer() const {
    Failure problem;
    auto endpoint = socket_.remote_endpoint(problem);
    return problem ? net::ip::address() : endpoint.address();
}

bool Stream::hasClientLeft() const {
    if (!socket_.is_open())
        return true;
    struct pollfd state {
        const_cast<Socket&>(socket_).native_handle(), POLLRDHUP, 0
    };
    return ::poll(&state, 1, 0) > 0;
}

void Stream::finish() {
    if (!socket_.is_open())
        return;
    if (session_ != nullptr && !isBroken_ && SSL_is_init_finished(session_)) {
        ERR_clear_error();
        SSL_shutdown(session_); // close_notify: what came is all there is (RFC 8446 §6.1)
    }
    Failure ignored;
    socket_.shutdown(Tcp::socket::shutdown_send, ignored);
}

void Stream::close() {
    Failure ignored;
    socket_.close(ignored);
}

void Stream::reset() {
    Failure ignored;
    socket_.set_option(net::socket_base::linger(true, 0), ignored);
    close();
}

} // namespace stipple::server
