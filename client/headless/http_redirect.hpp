// Where a redirect leads (RFC 9110 §15.4 and §10.2.2; references: RFC 3986 §5). Pure.
#pragma once

#include "client/headless/http_url.hpp"

#include <string>
#include <string_view>

namespace stipple {

// More in a row are taken for a circle.
inline constexpr int maxRedirects = 5;

// Of a GET: 301, 302, 303, 307, 308.
bool isRedirect(unsigned status);
// Whether later requests may go to the new address at once (301, 308).
bool isPermanentRedirect(unsigned status);

// The address that the field Location means, as a reference from `from`. Errors, with `where` as their place:
// networkFailed (no Location, or none that is an http or https address; from https to http, where anybody
// could answer).
Result<HttpUrl> redirectTarget(const HttpUrl& from, std::string_view location, const std::string& where);

// "https://example.org:443", in lower case and always with the port: what credentials belong to.
std::string originOf(const HttpUrl& url);

} // namespace stipple
