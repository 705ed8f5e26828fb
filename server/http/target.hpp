// The request target (RFC 9112 §3.2) as a path of decoded segments. What could be read in two ways is
// refused rather than repaired, so that no later step sees a path that an earlier one judged differently.
#pragma once

#include "shared/base/result.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

struct Target {
    std::vector<std::string> segments; // decoded once; "/" has none, "/a/" ends with an empty one
    std::string query;                 // not decoded, without "?"

    // Segments joined again: "clouds/town.stipple"; for opening files beneath a folder.
    std::string relativePath() const;
};

// Origin form ("/path?query") or absolute form ("http://host/path?query", also of https).
// Errors (invalidArgument): other forms, broken or cut percent-encoding, control bytes and NUL (plain or
// encoded), encoded slashes, backslashes, "." and ".." segments (plain or encoded), empty inner segments.
Result<Target> parseTarget(std::string_view target);

// Percent-encodes what is not unreserved (RFC 3986 §2.3).
std::string percentEncoded(std::string_view segment);

} // namespace stipple::server
