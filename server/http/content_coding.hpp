// Which content coding of a representation a client gets (RFC 9110 §8.4.1, §12.5.3). Pure.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace stipple::server {

struct ContentCoding {
    std::string_view name;   // as in the fields: "br"; "identity": as it is
    std::string_view suffix; // of a file that holds it: ".br"
};

// The codings in which the page's files lie beside the plain ones, best first (scripts/build_web.sh).
std::span<const ContentCoding> storedCodings();

// The quality, in thousandths, that the value of Accept-Encoding gives to a coding; 0: not wanted. No field
// (nothing) is taken as "identity". "*" speaks for codings that are not named; identity is the last resort
// (1) where neither speaks of it. "x-gzip" means gzip. Elements that can't be read are passed over; of a
// coding named twice the first counts.
int codingQuality(const std::optional<std::string>& acceptEncoding, std::string_view coding);

} // namespace stipple::server
