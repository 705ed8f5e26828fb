// The header of a request, from the bytes that came (RFC 9112 §2-5). First its end is found, line by line,
// and what others might read differently is refused there: bare line feeds, folded lines, bytes that can't
// begin a request. Then all of it is parsed at once (Boost.Beast), without copying.
#pragma once

#include "server/http/message.hpp"

#include <cstddef>
#include <string_view>

namespace stipple::server {

// Finds the end of a header in a buffer that fills up.
class HeaderScan {
  public:
    enum class State { needsMore, complete, malformed };

    // `bytes`: all that came of this request so far; begins where the last call's did. Bytes that were looked
    // at before are not looked at again.
    State scan(std::string_view bytes);

    // Once complete: the header with its empty line, without empty lines before it (RFC 9112 §2.2).
    std::string_view header(std::string_view bytes) const { return bytes.substr(begin_, end_ - begin_); }
    std::size_t endBytes() const { return end_; } // from the beginning of `bytes`
    bool isInRequestLine() const { return lines_ == 0; }

  private:
    std::size_t begin_ = 0, lineBegin_ = 0, looked_ = 0, end_ = 0;
    int lines_ = 0;
};

// Parses a complete header (as HeaderScan gives it) into `request`, whose views are of `header` then. Its
// list of fields keeps its memory. Answers 0, or the status of the refusal: 400 or 505.
int parseRequestHeader(std::string_view header, HttpRequest& request);

// True unless an HTTP/1.0 client, or "close" among the options of Connection, says otherwise (RFC 9112 §9.3).
bool wantsKeepAlive(const HttpRequest& request);

} // namespace stipple::server
