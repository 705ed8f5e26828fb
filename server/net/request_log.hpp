// What is known of a request once it is answered; server/log makes lines of it.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace stipple::server {

struct RequestRecord {
    std::int64_t timeMs = 0;                               // since 1970, when the answer was finished
    std::string client;                                    // address without port
    std::string user;                                      // name of the token in use; empty: none
    std::string method, target, range, referer, userAgent; // as the client sent them: anything may be in them
    int version = 11;
    std::string job;             // its kind, for an answer that a job made
    int status = 0;              // 499: the client left before there was one
    std::uint64_t bodyBytes = 0; // of the body, that were sent
    double milliseconds = 0;     // from the end of the request's header to the last byte handed over
    bool isComplete = true;      // false: the connection was cut before the end of the answer
};

// Called from the server's threads, also at once. Empty: no log.
using RequestLog = std::function<void(const RequestRecord&)>;

} // namespace stipple::server
