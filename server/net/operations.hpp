// Addresses for whoever runs the server, which it answers itself. Internal to server/net.
//
//   /healthz   200 {"status":"ok"}; 503 once its end is announced
//   /readyz    the same, and 503 while connections or jobs are at their limit
//   /metrics   Prometheus' text format, for whom ServerOptions::metrics lets in; to others there is no such
//   thing
#pragma once

#include "server/http/message.hpp"
#include "server/net/loop.hpp"

#include <optional>

namespace stipple::server {

// Nothing: it is a question for the handler. `peer`: who is connected, maybe a proxy.
std::optional<HttpResponse> answerOperations(const HttpRequest& request, ServerState& state,
                                             const net::ip::address& peer);

} // namespace stipple::server
