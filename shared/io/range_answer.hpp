// What an HTTP server said to a request for one byte range, judged before any of the body is read. The
// sources that speak HTTP (native sockets, a browser's fetch) share these rules:
//
//   206 whose Content-Range begins where asked          the body is read
//   200 to a range from byte 0 that holds a whole file  the body is read (a tiny file on a plain server)
//   200 otherwise                                       the server ignores Range: nothing is read
//   another file than before                            `changed`, whichever status says so
//   206 without Content-Range, at first                 `unsupported`: the server hides it
//   401, 403                                            `accessDenied`: asking again would not help
//   429, 503 and all others                             `networkFailed`, with the pause that Retry-After
//   names
//
// The version is pinned by what the first answer said: ETag, else Last-Modified, and the file's size. Later
// answers are compared with it. No If-Range or If-Match is sent: they would make every cross-origin read
// cost a preflight, and a 206 names the version that it belongs to anyway (RFC 9110 §15.3.7).
#pragma once

#include "shared/base/result.hpp"
#include "shared/io/byte_source.hpp"

#include <optional>
#include <string>

namespace stipple {

// The header fields as they came; empty where absent (or hidden by a browser, when not exposed by CORS).
struct RangeAnswer {
    int status = 0;
    std::string contentRange;
    std::string etag;
    std::string lastModified;
    std::optional<std::uint64_t> contentLength; // absent also when the body is content-coded
    std::string retryAfter = {};                // in seconds (shared/io/retry_after.hpp)
};

// The version of a file that a source reads. A default one pins nothing yet.
struct FileVersion {
    std::string etag;
    std::string lastModified;
    std::uint64_t sizeBytes = 0;
    bool pinned = false;
};

// What a replacement of the file may do unnoticed, where its server names versions badly: a sentence. Empty:
// the version is sure, or nothing was read yet.
std::string versionCaution(const FileVersion& version);

// Value of the request's Range field; `range.size` > 0.
std::string rangeField(ByteRange range); // "bytes=0-65535"

// The number of body bytes to read, which are the answer to `asked` (cut at the end of the file), or why
// not. Pins `version` at the first success. `where` is the address, for messages.
Result<std::uint64_t> judgeRangeAnswer(ByteRange asked, const RangeAnswer& answer, FileVersion& version,
                                       const std::string& where);

// The error of a source whose server was too slow, and how to tell it from other failures of a network.
Error noAnswerInTime(const std::string& where);
bool isTimeout(const Error& error);

} // namespace stipple
