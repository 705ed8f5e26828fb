// A client's bytes, plain or through TLS: the one thing that connections read from and write to. Nothing here
// blocks; a call that can't go on says what to wait for. Internal to server/net; lives on one loop's thread.
#pragma once

#include "server/net/asio.hpp"
#include "server/net/tls_context.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string_view>

namespace stipple::server {

enum class Wait {
    nothing,  // it went on
    readable, // wait until the socket can be read (TLS may need that to write, too)
    writable,
    never, // the client has left, or can't be understood
};

struct Moved {
    std::size_t bytes = 0; // 0 unless `wait` is nothing
    Wait wait = Wait::nothing;
};

class Stream {
  public:
    // Without `tls` plain. The socket becomes non-blocking and sends at once what it is given (TCP_NODELAY).
    Stream(Socket socket, std::shared_ptr<const TlsContext> tls);
    ~Stream();
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    // The handshake of TLS; nothing to do for plain streams. A client that speaks plain HTTP to TLS makes the
    // stream plain (spokePlainly()), so that it can be told.
    Task<bool> open();
    bool spokePlainly() const { return spokePlainly_; }

    // 0: the client has sent its last byte, or left.
    Task<std::size_t> readSome(char* to, std::size_t size);

    Moved write(std::string_view bytes);
    // Whether a write that could not go on may be followed by one from another place. (TLS has coded its
    // bytes already.)
    bool mayWriteAnew() const { return session_ == nullptr; }
    Task<bool> wait(Wait what);
    Task<bool> writeAll(std::string_view bytes);

    net::ip::address peer() const; // 0.0.0.0 if it has left already
    bool isOpen() const { return socket_.is_open(); }
    // Has the client closed, at least its sending side? Also with bytes of it unread.
    bool hasClientLeft() const;

    void finish(); // no more is sent from here; the client may still be read
    void close();  // what is pending fails
    void reset();  // the same, and what is not sent yet is dropped: the client sees a broken connection

  private:
    Wait waitAfter(int result);

    Socket socket_;
    std::shared_ptr<const TlsContext> tls_;
    ssl_st* session_ = nullptr;
    bool spokePlainly_ = false, isBroken_ = false;
};

} // namespace stipple::server
