// A socket that listens at 127.0.0.1, on a port that the system chooses; closed at the end.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>

namespace stipple::test {

class Listener {
  public:
    explicit Listener(int waiting = 8) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof address;
        ::bind(socket_, reinterpret_cast<sockaddr*>(&address), size);
        ::listen(socket_, waiting);
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
        origin_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port));
    }
    ~Listener() { ::close(socket_); }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

    const std::string& origin() const { return origin_; } // "http://127.0.0.1:PORT"
    // The next connection's socket, which the caller closes; below 0 once it is stopped.
    int accept() const { return ::accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC); }
    // Nobody is accepted any more; who waits for somebody stops.
    void stop() { ::shutdown(socket_, SHUT_RDWR); }

  private:
    int socket_;
    std::string origin_;
};

} // namespace stipple::test
