// An HTTP server that answers as a test says: for redirects, tokens and other things that ours never does.
#pragma once

#include "tests/http/support/listener.hpp"

#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>
#include <vector>

namespace stipple::test {

class ScriptedHttpServer {
  public:
    // From the header of a request, as it came, to the whole answer; "" closes the connection.
    using Answer = std::function<std::string(const std::string& header)>;

    explicit ScriptedHttpServer(Answer answer) : answer_(std::move(answer)) {
        acceptor_ = std::thread([this] { acceptForever(); });
    }
    ~ScriptedHttpServer() {
        listener_.stop();
        acceptor_.join();
        {
            std::lock_guard lock(mutex_);
            for (int client : clients_)
                ::shutdown(client, SHUT_RDWR);
        }
        for (std::thread& thread : threads_)
            thread.join();
    }
    ScriptedHttpServer(const ScriptedHttpServer&) = delete;
    ScriptedHttpServer& operator=(const ScriptedHttpServer&) = delete;

    std::string origin() const { return listener_.origin(); }
    std::vector<std::string> requests() const { // the headers that came
        std::lock_guard lock(mutex_);
        return requests_;
    }
    std::size_t connections() const {
        std::lock_guard lock(mutex_);
        return threads_.size();
    }

  private:
    void acceptForever() {
        for (int client; (client = listener_.accept()) >= 0;) {
            std::lock_guard lock(mutex_);
            clients_.push_back(client);
            threads_.emplace_back([this, client] { serve(client); });
        }
    }
    void serve(int client) {
        std::string received;
        char bytes[4096];
        for (ssize_t count; (count = ::recv(client, bytes, sizeof bytes, 0)) > 0;) {
            received.append(bytes, static_cast<std::size_t>(count));
            for (std::size_t end; (end = received.find("\r\n\r\n")) != std::string::npos;) {
                std::string header = received.substr(0, end + 4);
                received.erase(0, end + 4);
                {
                    std::lock_guard lock(mutex_);
                    requests_.push_back(header);
                }
                std::string answer = answer_(header);
                if (answer.empty())
                    ::shutdown(client, SHUT_RDWR);
                else
                    (void)!::send(client, answer.data(), answer.size(), MSG_NOSIGNAL);
            }
        }
        std::lock_guard lock(mutex_);
        clients_.remove(client);
        ::close(client);
    }

    const Answer answer_;
    Listener listener_{64};
    mutable std::mutex mutex_;
    std::vector<std::string> requests_;
    std::list<int> clients_;
    std::vector<std::thread> threads_;
    std::thread acceptor_;
};

inline std::string redirectTo(const std::string& location, const char* status = "302 Found") {
    return std::string("HTTP/1.1 ") + status + "\r\nLocation: " + location +
           "\r\nContent-Length: 5\r\n\r\nmoved";
}

// Ten bytes "0123456789" of a file of 10 whose tag is "v".
inline std::string tenBytes() {
    return "HTTP/1.1 206 Partial Content\r\nContent-Range: bytes 0-9/10\r\nETag: \"v\"\r\nContent-Length: "
           "10\r\n\r\n0123456789";
}

} // namespace stipple::test
