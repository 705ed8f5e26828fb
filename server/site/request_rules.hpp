// What a parser leaves to the server (RFC 9112 §3.2, §6, §9; RFC 9110 §10.1.1): the Host field, bodies,
// Expect. No endpoint takes a body, so a request that has one, or might have one by someone's reading, is
// refused and its connection closed: nothing behind it can be taken for a request of its own.
#pragma once

#include "server/http/message.hpp"

#include <optional>

namespace stipple::server {

// A refusal, or nothing if the request may be routed.
std::optional<HttpResponse> checkRequestRules(const HttpRequest& request);

} // namespace stipple::server
