#include "tests/http/support/raw_client.hpp"

#include <algorithm>
#include <arpa/inet.h>
#include <cctype>
#include <chrono>
#include <netinet/in.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <poll.h>
#include <sstream>
#include <sys/socket.h>
#include <unistd.h>

namespace stipple::test {

RawClient::RawClient(std::uint16_t port, const char* from) {
    socket_ = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    ::inet_pton(AF_INET, from, &address.sin_addr);
    ::bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address);
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (socket_ >= 0 && ::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0) {
        ::close(socket_);
        socket_ = -1;
    }
}

RawClient::~RawClient() {
    SSL_free(tls_);
    if (socket_ >= 0)
        ::close(socket_);
}

bool RawClient::send(std::string_view bytes) {
    while (!bytes.empty()) {
        ssize_t sent = tls_ == nullptr ? ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                       : SSL_write(tls_, bytes.data(), static_cast<int>(bytes.size()));
        if (sent <= 0)
            return false;
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return true;
}

bool RawClient::fill(int milliseconds) {
    if (socket_ < 0)
        return false; // never connected
    if (tls_ == nullptr || SSL_pending(tls_) == 0) {
        pollfd waiting{socket_, POLLIN, 0};
        if (::poll(&waiting, 1, milliseconds) <= 0)
            return false;
    }
    char bytes[65536];
    ERR_clear_error();
    ssize_t got = tls_ == nullptr ? ::recv(socket_, bytes, sizeof bytes, 0)
                                  : SSL_read(tls_, bytes, static_cast<int>(sizeof bytes));
    wasTold_ = tls_ != nullptr && SSL_get_error(tls_, static_cast<int>(got)) == SSL_ERROR_ZERO_RETURN;
    isReset_ = isReset_ || got < 0;
    if (got <= 0)
        return false;
    buffer_.append(bytes, static_cast<std::size_t>(got));
    return true;
}

bool RawClient::startTls(const std::vector<std::string>& protocols, int newest) {
    SSL_CTX* context = SSL_CTX_new(TLS_client_method());
    SSL_CTX_set_security_level(context, 0); // also what a server must refuse
    SSL_CTX_set_min_proto_version(context, TLS1_VERSION);
    SSL_CTX_set_max_proto_version(context, newest);
    std::string offered;
    for (const std::string& protocol : protocols)
        offered += static_cast<char>(protocol.size()) + protocol;
    SSL_CTX_set_alpn_protos(context, reinterpret_cast<const unsigned char*>(offered.data()),
                            static_cast<unsigned>(offered.size()));
    tls_ = SSL_new(context);
    SSL_CTX_free(context); // the session keeps it
    SSL_set_fd(tls_, socket_);
    return SSL_connect(tls_) == 1;
}

std::string RawClient::tlsVersion() const {
    return SSL_get_version(tls_);
}

std::string RawClient::tlsProtocol() const {
    const unsigned char* name = nullptr;
    unsigned size = 0;
    SSL_get0_alpn_selected(tls_, &name, &size);
    return {reinterpret_cast<const char*>(name), size};
}

std::string RawClient::peerName() const {
    X509* certificate = SSL_get1_peer_certificate(tls_);
    char name[256] = "";
    if (certificate != nullptr)
        X509_NAME_get_text_by_NID(X509_get_subject_name(certificate), NID_commonName, name, sizeof name);
    X509_free(certificate);
    return name;
}

RawResponse RawClient::receive(bool hasBody) {
    RawResponse response;
    std::size_t end;
    while ((end = buffer_.find("\r\n\r\n")) == std::string::npos)
        if (!fill())
            return response;
    response.head = buffer_.substr(0, end);
    buffer_.erase(0, end + 4);

    std::istringstream lines(response.head);
    std::string line;
    std::getline(lines, line);
    response.status = line.size() > 12 ? std::atoi(line.c_str() + 9) : 0;
    while (std::getline(lines, line)) {
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        std::size_t colon = line.find(": ");
        std::string name = line.substr(0, colon);
        std::transform(name.begin(), name.end(), name.begin(),
                       [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
        response.fields[name] = colon == std::string::npos ? "" : line.substr(colon + 2);
    }
    if (hasBody && response.fields.count("transfer-encoding") > 0) {
        receiveChunks(response);
        return response;
    }
    if (hasBody && response.fields.count("content-length") == 0 && response.status == 200) {
        receiveUntilClose(response);
        return response;
    }
    std::size_t length = hasBody ? std::strtoull(response.field("content-length").c_str(), nullptr, 10) : 0;
    while (buffer_.size() < length)
        if (!fill())
            break;
    response.isComplete = buffer_.size() >= length;
    response.body = buffer_.substr(0, length);
    buffer_.erase(0, response.body.size());
    return response;
}

// Strict: the coding is "chunked" alone, sizes have no extensions, and every line ends as it should.
void RawClient::receiveChunks(RawResponse& response) {
    if (response.field("transfer-encoding") != "chunked")
        return;
    for (;;) {
        std::size_t end;
        while ((end = buffer_.find("\r\n")) == std::string::npos)
            if (!fill())
                return;
        std::string digits = buffer_.substr(0, end);
        if (digits.empty() || digits.find_first_not_of("0123456789abcdef") != std::string::npos)
            return;
        std::size_t size = std::strtoull(digits.c_str(), nullptr, 16);
        while (buffer_.size() < end + 2 + size + 2)
            if (!fill())
                return;
        response.body.append(buffer_, end + 2, size);
        if (buffer_.compare(end + 2 + size, 2, "\r\n") != 0)
            return;
        buffer_.erase(0, end + 2 + size + 2);
        if (size == 0)
            break;
        ++response.chunks;
    }
    response.isComplete = true;
}

void RawClient::receiveUntilClose(RawResponse& response) {
    while (fill()) {
    }
    response.isComplete = !isReset_;
    response.body.swap(buffer_);
}

RawResponse RawClient::ask(std::string_view request) {
    std::string bytes;
    for (char c : request)
        bytes += c == '\n' ? std::string("\r\n") : std::string(1, c);
    send(bytes + "\r\n\r\n");
    return receive(!request.starts_with("HEAD "));
}

const std::string& RawClient::peek() {
    fill(0);
    return buffer_;
}

bool RawClient::isClosedWithin(int milliseconds) {
    if (tls_ != nullptr) {
        auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds);
        return !fill(milliseconds) && buffer_.empty() && std::chrono::steady_clock::now() < end;
    }
    pollfd waiting{socket_, POLLIN, 0};
    char byte;
    return buffer_.empty() && ::poll(&waiting, 1, milliseconds) == 1 && ::recv(socket_, &byte, 1, 0) <= 0;
}

void RawClient::setReceiveBuffer(int bytes) {
    ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof bytes);
}

void RawClient::finishSending() {
    ::shutdown(socket_, SHUT_WR);
}

RawResponse askOnce(std::uint16_t port, std::string_view request) {
    RawClient client(port);
    return client.ask(request);
}

std::string golden(const RawResponse& response) {
    std::istringstream lines(response.head);
    std::string line, text;
    while (std::getline(lines, line)) {
        if (!line.empty() && line.back() == '\r')
            line.pop_back();
        if (line.starts_with("Date: "))
            continue;
        for (const char* name : {"ETag", "Last-Modified", "Content-Security-Policy"})
            if (line.starts_with(std::string(name) + ": "))
                line = std::string(name) + ": <...>";
        if (std::size_t at = line.find("boundary="); at != std::string::npos)
            line = line.substr(0, at) + "boundary=<boundary>";
        text += line + "\n";
    }
    return text;
}

} // namespace stipple::test
