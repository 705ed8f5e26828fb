// The tokens that other servers want of this one, by origin: each is sent to that origin and to no other,
// also where a server redirects. They come from a file, never from the command line, which every user of the
// machine can read. Thread: any; const once loaded.
//
//   # origin                          token
//   https://bucket.example            2YotnFZFEjr1zCsicMWpAA
//   http://10.0.0.7:8017              stp_…
#pragma once

#include "shared/base/result.hpp"

#include <map>
#include <string>
#include <string_view>

namespace stipple::server {

class UpstreamTokens {
  public:
    UpstreamTokens() = default; // none
    // Errors: those of opening; invalidArgument (every user can read the file; a line that is not an origin
    // and a token, without what it holds), limitExceeded.
    static Result<UpstreamTokens> load(const std::string& path);
    // Errors: invalidArgument, with the number of the line.
    static Result<UpstreamTokens> parse(std::string_view text);

    // For an origin as originOf() writes it; empty: none.
    std::string of(const std::string& origin) const;

  private:
    std::map<std::string, std::string> tokens_;
};

} // namespace stipple::server
