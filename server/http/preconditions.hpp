// Conditional requests: RFC 9110 §13, evaluated in the order of §13.2.2.
#pragma once

#include "server/http/message.hpp"

#include <cstdint>
#include <string>

namespace stipple::server {

// What a representation is known by.
struct Validators {
    std::string etag;                     // strong, with quotes
    std::int64_t lastModifiedSeconds = 0; // since 1970; 0: unknown, dates are then ignored
};

enum class Precondition { passed, notModified, failed }; // go on, 304, 412

// Steps 1-4: If-Match, If-Unmodified-Since, If-None-Match, If-Modified-Since. `request` is GET or HEAD.
Precondition evaluatePreconditions(const HttpRequest& request, const Validators& validators,
                                   std::int64_t nowSeconds);

// Step 5: whether Range counts: there is no If-Range, or it names this version by a strong tag or the exact
// date.
bool rangeApplies(const HttpRequest& request, const Validators& validators, std::int64_t nowSeconds);

} // namespace stipple::server
