// A client that sends bytes as they are given and reads answers, over one blocking socket to 127.0.0.1. Every
// wait ends after ten seconds, so a server that hangs fails a test instead of stopping it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

struct ssl_st; // OpenSSL's SSL

namespace stipple::test {

struct RawResponse {
    int status = 0;
    std::string head;                          // status line and fields, as sent, without the empty line
    std::map<std::string, std::string> fields; // names in lower case
    std::string body;                          // decoded, if it came in chunks
    bool isComplete = false;                   // the whole body came
    int chunks = 0;                            // of the chunked transfer coding, without the last one

    std::string field(const std::string& lowerName) const {
        auto found = fields.find(lowerName);
        return found == fields.end() ? "" : found->second;
    }
};

class RawClient {
  public:
    // `from`: its own address, one of 127.0.0.0/8.
    explicit RawClient(std::uint16_t port, const char* from = "127.0.0.1");
    ~RawClient();
    RawClient(const RawClient&) = delete;
    RawClient& operator=(const RawClient&) = delete;

    // Speaks TLS from here on, as an https client does; any certificate will do. False if that fails.
    // `protocols`: offered by ALPN; `newest`: the latest version of TLS that is spoken, 0x0304 for 1.3.
    bool startTls(const std::vector<std::string>& protocols = {"http/1.1"}, int newest = 0x0304);
    std::string tlsVersion() const;
    std::string tlsProtocol() const; // that ALPN chose
    std::string peerName() const;    // common name in the server's certificate
    // After the end of the connection: the server had said that this is the end (close_notify).
    bool wasTold() const { return wasTold_; }

    bool isConnected() const { return socket_ >= 0; }
    bool send(std::string_view bytes);
    // The next answer; status 0 if the connection ends first. `hasBody` false: the answer to a HEAD.
    RawResponse receive(bool hasBody = true);
    // send() and receive(); "\n" in `request` stands for "\r\n", and the empty line is added.
    RawResponse ask(std::string_view request);
    // What has come so far, which receive() will take.
    const std::string& peek();
    // True if the server closes the connection, with nothing more sent, within `milliseconds`.
    bool isClosedWithin(int milliseconds);
    void setReceiveBuffer(int bytes); // before much was received
    void finishSending();

  private:
    void receiveChunks(RawResponse& response);
    void receiveUntilClose(RawResponse& response);
    bool fill(int milliseconds = 10'000); // reads more into buffer_; false at the end
    int socket_ = -1;
    ssl_st* tls_ = nullptr;
    bool isReset_ = false, wasTold_ = false;
    std::string buffer_;
};

// One request on a connection of its own.
RawResponse askOnce(std::uint16_t port, std::string_view request);

// Status and fields in the order sent, for comparing with a golden text: without Date; the values of ETag,
// Last-Modified and Content-Security-Policy replaced by <...> where present, multipart boundaries by
// <boundary>.
std::string golden(const RawResponse& response);

} // namespace stipple::test
