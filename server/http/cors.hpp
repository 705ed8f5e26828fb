// Which pages of other origins may read an answer (the CORS protocol of the Fetch standard).
//
// What everybody may read, every origin may read ("*"): clouds are hosted to be shown in pages elsewhere, and
// an origin that was refused would only send its reader to a program that has none. A server for this machine
// alone is another thing: whatever page its user visits runs on this machine, too, and must not read their
// scans; there only listed origins may. What needs a token or a signed address is for the listed origins
// alone, and its answers vary by the field Origin. Cookies are never used, so nothing is sent with a request
// that the page did not put there itself.
#pragma once

#include "server/http/message.hpp"
#include "shared/base/result.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

class CorsRules {
  public:
    // Who may read what needs no credentials.
    enum class PublicFor { everyOrigin, listedOrigins };

    CorsRules() = default; // no origin is listed, public is for all
    // `origins`: "https://example.org", "http://localhost:8080", or "*" for every origin. Errors
    // (invalidArgument): a path, no scheme, or other things that no browser sends as an origin.
    static Result<CorsRules> listing(const std::vector<std::string>& origins,
                                     PublicFor publicFor = PublicFor::everyOrigin);

    bool lists(std::string_view origin) const;
    // Whether any origin may have an answer that needs no credentials.
    bool isPublicForAll() const { return listsAll_ || publicFor_ == PublicFor::everyOrigin; }

    // On every status once: a browser hides a 404 or 412 without these fields as it would hide a 200.
    // `isForAll`: what the answer says needs no credentials.
    void complete(const HttpRequest& request, HttpResponse& response, bool isForAll) const;

  private:
    std::vector<std::string> origins_;
    bool listsAll_ = false;
    PublicFor publicFor_ = PublicFor::everyOrigin;
};

// What OPTIONS answers: the methods, and for a preflight the fields that a request may carry, to be
// remembered for two hours. Says nothing about what is at the address.
HttpResponse preflightResponse(const std::string& allowedMethods);

// An origin as browsers write it (RFC 6454 §6.2), or an error: lower case, without the scheme's own port.
Result<std::string> parseOrigin(std::string_view text);

} // namespace stipple::server
