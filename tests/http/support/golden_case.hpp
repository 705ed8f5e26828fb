// Conversations with a server as files that people read: what is sent, what must come back. The lines are
//
//   any text              what the case is about, before the first request
//   > GET / HTTP/1.1      sent, with CRLF; "> " lines that follow each other leave in one write
//   < HTTP/1.1 200 OK     the head that comes back, field by field in the order sent
//   | abc                 the body, if it is short text; else its size
//   = stays open          or "= closed": what becomes of the connection
//
// In requests, \xHH is a byte, {repeat N TEXT} is TEXT N times, and {NAME} is what the caller's names say.
// The values of Date and ETag are not compared, nor multipart boundaries, nor the length of JSON that has
// tags in it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace stipple::test {

// What a {NAME} of a request stands for: "etag /letters.txt", "token".
using GoldenNames = std::function<std::string(const std::string& name)>;

// Plays the requests of `caseText` to the server at 127.0.0.1 and returns the case as it should then read:
// the same text if the server answers as it says. `isApart`: each write on a connection of its own, and no
// word on what becomes of it; for servers that close more often.
std::string playGoldenCase(const std::string& caseText, std::uint16_t port, const GoldenNames& names,
                           bool isApart = false);

} // namespace stipple::test
