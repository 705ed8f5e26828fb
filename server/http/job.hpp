// An answer that takes longer than a look-up: made by a job thread, not by the event loop that the client's
// connection lives on, and sent while it is being made.
#pragma once

#include "server/http/client_rate.hpp"
#include "server/http/message.hpp"
#include "shared/base/bytes.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <variant>

namespace stipple::server {

struct Job;

// Where a job puts its answer: either answer(), or begin() and then any number of write()s, or another job
// by handOver(). Thread: the job's.
class AnswerWriter {
  public:
    virtual ~AnswerWriter() = default;

    // The whole answer at once, with its length.
    virtual void answer(HttpResponse response) = 0;

    // Status and fields of an answer whose length is not known yet (chunked transfer coding; HTTP/1.0: until
    // the connection closes). Its body is empty, or tells the length after all: parts of no file (FileSlice),
    // whose bytes are then written.
    virtual Status begin(HttpResponse head) = 0;
    // More of the body. Waits while the client is behind, so a job never holds more than it is making.
    // `cancelled` once the client has left or the job's time is over: the job ends then.
    virtual Status write(ByteSpan bytes) = 0;

    // True from then on; for work that goes on for long between two writes.
    virtual const std::atomic<bool>& isStopped() const = 0;

    // Another job answers, in its own turn, once this one has ended; nothing may have been answered yet.
    virtual void handOver(Job next) = 0;
};

struct Job {
    std::string kind; // "points", "image", …: for limits, logs and metrics
    // A failure before anything was answered becomes a problem document; after begin(), the connection is
    // cut, so that the client sees that the answer is not complete. What it captures it owns (the request's
    // views do not outlive the look-up).
    std::function<Status(AnswerWriter&)> run;
    // How often a client may have such an answer; null: as often as it likes. Beyond it: 429.
    std::shared_ptr<ClientRate> rate = nullptr;
    // It waits for another server and computes next to nothing: not among those that compute, and with
    // limits of its own.
    bool isTransfer = false;
};

using Answer = std::variant<HttpResponse, Job>;

} // namespace stipple::server
