// A request and a response as plain values. What answers requests (server/site) knows no socket; what moves
// bytes (server/net) knows no meaning.
#pragma once

#include "server/files/open_file.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stipple::server {

bool equalIgnoringCase(std::string_view a, std::string_view b); // ASCII
std::string_view trimmed(std::string_view text);                // spaces and tabs

// Views borrow from the connection's buffer while the request is answered.
struct HttpRequest {
    std::string_view method; // case-sensitive: "GET"
    std::string_view target; // as received: "/clouds/town.stipple?x=1"
    int version = 11;        // major × 10 + minor
    std::vector<std::pair<std::string_view, std::string_view>> fields;

    int count(std::string_view name) const;
    // The value of a field; several lines are one list, joined by ", " (RFC 9110 §5.3).
    std::optional<std::string> field(std::string_view name) const;
};

// A copy of a request that outlives the connection's buffer, for jobs.
class KeptRequest {
  public:
    explicit KeptRequest(const HttpRequest& request);
    KeptRequest(const KeptRequest&) = delete;
    KeptRequest& operator=(const KeptRequest&) = delete;
    const HttpRequest& request() const { return request_; }

  private:
    std::string text_; // all that request_ has views of
    HttpRequest request_;
};

// A piece of a file, kept open until it is sent. Invariant: offset + size <= file->identity().sizeBytes.
// Without a file, its bytes are elsewhere: a job writes them (AnswerWriter::begin).
struct FileSlice {
    std::shared_ptr<const OpenFile> file;
    std::uint64_t offset = 0, size = 0;
};

using BodyPart = std::variant<std::string, FileSlice>;

struct HttpResponse {
    int status = 200;
    std::vector<std::pair<std::string_view, std::string>> fields; // names are literals
    std::vector<BodyPart> body;
    bool sendsBody = true; // false for HEAD: Content-Length speaks of a body that does not follow
    bool closes = false;   // the connection can't be used after this response

    void set(std::string_view name, std::string value);              // adds or replaces
    void addToList(std::string_view name, std::string_view element); // "Vary: Origin, Accept"; each once
    std::string field(std::string_view name) const;                  // empty where absent
    std::uint64_t bodyBytes() const;
};

const char* reasonPhrase(int status);

// How a reader finds the end of a body (RFC 9112 §6.3).
enum class BodyFraming {
    length,     // Content-Length
    chunked,    // chunked transfer coding
    untilClose, // the end of the connection; for HTTP/1.0
};

// Appends status line and fields with Date, Content-Length (RFC 9110 §8.6: not with 204 and 304) or
// Transfer-Encoding, and Connection, up to and with the empty line.
void appendResponseHead(std::string& head, const HttpResponse& response, std::int64_t nowSeconds,
                        bool keepsAlive, BodyFraming framing);

} // namespace stipple::server
