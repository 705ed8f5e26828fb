// What the server's sockets ask for answers. Knows no socket, as they know no meaning. Thread: any.
#pragma once

#include "server/http/job.hpp"
#include "server/http/measurement.hpp"
#include "server/http/message.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace stipple::server {

class RequestHandler {
  public:
    virtual ~RequestHandler() = default;

    // Never waits for long: what takes longer than a look-up is a Job. A response is complete().
    virtual Answer answer(const HttpRequest& request, std::int64_t nowSeconds) const = 0;

    // Gives a response that answer() has not seen (a job's, a refusal by the server itself) what every answer
    // to `request` carries. The request is empty where the client's bytes were none.
    virtual void complete(const HttpRequest& request, HttpResponse& response) const = 0;

    // Who sent the request, for the log; empty: nobody in particular.
    virtual std::string userOf(const HttpRequest&) const { return {}; }

    // The system has no descriptors left for clients: closes files that can be opened again.
    virtual void spareDescriptors() const {}

    // What /metrics shows beside the server's own: caches, and the like.
    virtual std::vector<Measurement> measurements() const { return {}; }
};

} // namespace stipple::server
