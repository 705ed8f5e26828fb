// A byte source over HTTP/1.1: range requests (RFC 9110 §14) on one address, on up to six kept-alive
// connections, for native programs. The browser has its own (client/web).
//
// * Nothing is trusted: every answer's status, Content-Range and length are checked. A server that answers
//   200 with the whole file is stopped at once (the body is not read) and reported.
// * One version: the first answer pins the file's ETag (else Last-Modified) and size; later requests carry
//   If-Match, and any other version answers `changed`.
// * No waiter hangs: connecting, the header of an answer and each further piece of a body have time limits
//   (isTimeout()).
// * https: the server's certificate must rest on one that is trusted and name the host; else `networkFailed`.
// * Redirects are followed, maxRedirects in a row; each origin gets the token that is meant for it, if any.
//
// Thread: as ByteSource; all network work happens inside pump(), nothing runs in between. Memory: the
// ranges asked for, plus 16 KiB a connection.
#pragma once

#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/io/range_answer.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace stipple {

class TlsTrust;

struct HttpSourceOptions {
    int connections = 6; // at most, as browsers have to one host; opened when needed
    std::chrono::milliseconds connectTimeout{10'000};
    std::chrono::milliseconds headerTimeout{30'000};     // request sent until the answer's header is complete
    std::chrono::milliseconds noProgressTimeout{30'000}; // between two pieces of a body
    std::shared_ptr<TlsTrust> trust = {};                // for https; null: the system's
    FileVersion version = {};                            // to insist on from the start; unpinned: any
    // The token to send to an origin (originOf(), http_redirect.hpp) as Authorization: Bearer (RFC 6750);
    // empty, or null: none.
    std::function<std::string(const std::string& origin)> tokenFor = {};
    // Called once, by pump(), when the first answer has pinned a version.
    std::function<void(const FileVersion&)> onVersion = {};
};

// Does no network work yet: an address that can't be reached is reported by the first read.
// Errors: invalidArgument (not an address), unsupported (schemes other than http and https); for https, what
// TlsTrust::load says of the system's certificates.
Result<std::unique_ptr<ByteSource>> openHttpSource(const std::string& url,
                                                   const HttpSourceOptions& options = {});

// An address ("http://…", "https://…") by HTTP, anything else as a file.
Result<std::unique_ptr<ByteSource>> openSource(const std::string& pathOrUrl);

} // namespace stipple
