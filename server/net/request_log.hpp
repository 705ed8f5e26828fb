// One line for each request: what was asked, what was answered, how many bytes left.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace stipple::server {

struct RequestRecord {
    std::int64_t timeMs = 0; // since 1970, when the answer was finished
    std::string client;      // address without port
    std::string method, target, range;
    std::string job;             // its kind, for an answer that a job made
    int status = 0;              // 499: the client left before there was one
    std::uint64_t bodyBytes = 0; // of the body, that were sent
    double milliseconds = 0;     // from the end of the request's header to the last byte handed over
    bool isComplete = true;      // false: the connection was cut before the end of the answer
};

// Called from the server's threads, one record at a time. Empty: no log.
using RequestLog = std::function<void(const RequestRecord&)>;

// 2026-01-31T12:00:00.000Z 127.0.0.1 GET /clouds/town.stipple range="bytes=0-65535" status=206 bytes=65536
// ms=0.41 without a line end. Control bytes, quotes and backslashes of the client are escaped, and its texts
// are cut after 512 bytes; an answer that was cut has " cut" at the end.
std::string formatRecord(const RequestRecord& record);

} // namespace stipple::server
