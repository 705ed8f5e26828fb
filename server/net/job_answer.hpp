// The connection's side of a job: hands it to the pool, waits for what it answers while watching whether the
// client is still there, and sends a body whose length nobody knows yet. Internal to server/net; lives on its
// connection's loop.
#pragma once

#include "server/net/loop.hpp"
#include "server/net/response_sender.hpp"
#include "server/net/stream.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace stipple::server {

class JobAnswer {
  public:
    // How often a client is looked at while its job waits or works; it is gone once it has closed its sending
    // side, too (as nginx sees it).
    static constexpr std::chrono::milliseconds glance{25};

    // `client`: whom the limits count it for.
    JobAnswer(Loop& loop, Stream& stream, std::string client, Job job, bool headOnly);
    ~JobAnswer(); // the job is taken back if it is not over
    JobAnswer(const JobAnswer&) = delete;
    JobAnswer& operator=(const JobAnswer&) = delete;

    // Until the job has answered, or can't: a refusal or a failure is a problem document. Nothing: the client
    // has left.
    Task<std::optional<HttpResponse>> wait();
    // Whether what wait() gave is a head only, and sendBody() has to follow.
    bool isStreamed() const { return isStreamed_; }

    // How the body's end is told to a client of this version of HTTP.
    BodyFraming framing(const HttpResponse& head, int version) const;

    // Sends `head` and the body as the job makes it; only for what is no answer to a HEAD. Not complete if
    // the job failed or was stopped: the connection must be cut then.
    Task<SendOutcome> sendBody(std::string_view head, BodyFraming framing, std::function<void()> onProgress);

  private:
    void prepare(Job job);
    JobPool& pool() const { return loop_.state().poolOf(*run_); }
    Task<void> nextNews();
    void appendPiece(std::string_view piece, bool isLast);
    std::optional<HttpResponse> rateRefusal() const;
    std::optional<HttpResponse> submit();
    std::optional<HttpResponse> refusal(JobPool::Admission admission) const;
    bool isOverTime() const;
    HttpResponse overTimeProblem() const;

    Loop& loop_;
    Stream& stream_;
    std::string client_;
    std::shared_ptr<Timer> wake_; // shared with what other threads post
    std::shared_ptr<JobRun> run_;
    std::shared_ptr<ClientRate> rate_; // of the job's kind, or null
    std::chrono::steady_clock::time_point submitted_;
    const bool headOnly_;
    bool isSubmitted_ = false, isStreamed_ = false;

    JobNews news_;     // the last
    std::string body_; // taken from the run, being sent
    std::string out_;  // framed, being sent
    BodyFraming framing_ = BodyFraming::chunked;
    SendOutcome outcome_;
};

} // namespace stipple::server
