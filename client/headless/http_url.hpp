// The parts of an http or https address (RFC 3986, RFC 9110 §4.2) that a request needs.
#pragma once

#include "shared/base/result.hpp"

#include <string>
#include <string_view>

namespace stipple {

struct HttpUrl {
    bool isSecure = false; // https
    std::string host;      // for resolving: "example.org", "127.0.0.1", "::1"
    std::string port;      // "80" or "443" unless given
    std::string authority; // for the Host field: "example.org:8017", "[::1]"
    std::string target;    // path and query, "/" at least; the fragment is dropped
};

// True if `text` starts with a scheme ("http://", "https://", …) and so is no path.
bool looksLikeUrl(std::string_view text);

// Errors: unsupported (a scheme other than http and https), invalidArgument (user names, control bytes, bad
// ports).
Result<HttpUrl> parseHttpUrl(std::string_view url);

} // namespace stipple
