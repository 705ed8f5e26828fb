// Sends a response's head and body: our own body, because Beast's file_body can't stop at the end of a range
// and reads 4 KiB at a time. Internal to server/net.
#pragma once

#include "server/http/message.hpp"
#include "server/net/loop.hpp"

#include <boost/asio/awaitable.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <functional>
#include <string>

namespace stipple::server {

struct SendOutcome {
    bool isComplete = false;
    std::uint64_t bodyBytes = 0; // that were handed to the socket
};

// The head and the first 64 KiB of the body leave in one writev; larger parts of files follow by sendfile.
// `onProgress` is called before each piece of at most 256 KiB. A file that was cut or written to since it was
// opened ends the body early: never padding, never bytes of another version.
boost::asio::awaitable<SendOutcome> sendResponse(Loop& loop, boost::asio::ip::tcp::socket& socket,
                                                 std::string head, const HttpResponse& response,
                                                 std::function<void()> onProgress);

} // namespace stipple::server
