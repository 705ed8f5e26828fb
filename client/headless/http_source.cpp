#include "client/headless/http_source.hpp"

#include "client/headless/http_redirect.hpp"
#include "client/headless/http_url.hpp"
#include "client/headless/tls_trust.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "shared/io/range_answer.hpp"
#include "shared/io/retry_after.hpp"

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <boost/asio/ssl/stream.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http.hpp>
#include <ctime>
#include <deque>
#include <limits>
#include <optional>
#include <vector>

namespace stipple {

namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Tcp = net::ip::tcp;
using Failure = boost::system::error_code;
using Clock = std::chrono::steady_clock;
constexpr auto answered = net::as_tuple(net::use_awaitable);

// What is left of a cancelled answer is read to its end if it is this little: cheaper than connecting anew.
constexpr std::uint64_t drainBytes = 64 * 1024;
constexpr std::size_t readBufferBytes = 16 * 1024;
constexpr std::size_t maxHeaderBytes = 64 * 1024;

struct Job {
    ByteSource::RequestId id = 0;
    ByteRange range;
    ByteSource::Completion done;
    bool cancelled = false; // answered already; what still arrives for it is thrown away
    ByteSource::Progress progress = {};
};
using JobPtr = std::shared_ptr<Job>;

using TlsStream = net::ssl::stream<beast::tcp_stream&>; // borrows the stream below it

struct Connection {
    Connection(net::io_context& context, std::string to) : stream(context), origin(std::move(to)) {}
    beast::tcp_stream stream;
    const std::string origin;
    Tcp::resolver::results_type endpoints;
    std::optional<TlsStream> tls; // https: one for each time it is opened
    beast::flat_buffer buffer{readBufferBytes};
    bool isOpen = false;
};

// Takes jobs from the queue, one after the other; its connections lead to where the address does, and to
// where that redirects.
struct Worker {
    explicit Worker(net::io_context& context) : wake(context) {}
    Connection& connectionTo(net::io_context& context, const std::string& origin) {
        for (auto& connection : connections)
            if (connection->origin == origin)
                return *connection;
        constexpr std::size_t kept = 3;
        if (connections.size() == kept)
            connections.erase(connections.begin() + 1);
        connections.push_back(std::make_unique<Connection>(context, origin));
        return *connections.back();
    }
    net::steady_timer wake; // expires never; cancelled to wake an idle worker
    bool isIdle = false;
    std::vector<std::unique_ptr<Connection>> connections; // not in use while another one is
};

// How an attempt ended; `stale`: a kept-alive connection was closed before a byte of the answer came, so the
// request (a GET) may be sent again on a new one (RFC 9112 §9.3.1).
struct Attempt {
    Result<Bytes> result = Bytes();
    bool stale = false;
    unsigned redirect = 0; // the status of one, with its Location
    std::string location = {};
};

std::string field(const http::fields& fields, http::field name) {
    auto found = fields.find(name);
    return found == fields.end() ? std::string() : std::string(found->value());
}

class HttpSource final : public ByteSource {
  public:
    HttpSource(HttpUrl url, std::string name, const HttpSourceOptions& options)
        : url_(std::move(url)), name_(std::move(name)), options_(options), version_(options.version) {}

    ~HttpSource() override {
        *alive_ = false;
        closing_ = true;
        std::vector<Completion> open;
        for (auto& [done, result] : ready_)
            open.push_back(std::move(done));
        for (auto* jobs : {&queue_, &active_})
            for (JobPtr& job : *jobs)
                if (!job->cancelled)
                    open.push_back(std::move(job->done));
        for (Completion& done : open)
            done(cancelledError());
    }

    RequestId read(ByteRange range, Completion done) override {
        RequestId id = ++nextId_;
        if (closing_)
            done(cancelledError());
        else if (range.size == 0)
            done(Bytes{});
        else if (range.offset > std::numeric_limits<std::uint64_t>::max() - range.size)
            done(Error{ErrorCode::invalidArgument, "the range ends beyond 2^64", name_, ""});
        else
            enqueue(std::make_shared<Job>(Job{id, range, std::move(done)}));
        return id;
    }

    void cancel(RequestId id) override {
        auto hasId = [id](const JobPtr& job) { return job->id == id && !job->cancelled; };
        if (auto queued = std::find_if(queue_.begin(), queue_.end(), hasId); queued != queue_.end()) {
            ready_.emplace_back(std::move((*queued)->done), cancelledError());
            queue_.erase(queued);
        } else if (auto active = std::find_if(active_.begin(), active_.end(), hasId);
                   active != active_.end()) {
            ready_.emplace_back(std::move((*active)->done), cancelledError());
            (*active)->cancelled = true;
        }
    }

    bool forgetVersion() override {
        version_ = options_.version;
        return !version_.pinned;
    }

    Progress progress(RequestId id) const override {
        for (const JobPtr& job : active_)
            if (job->id == id && !job->cancelled)
                return job->progress;
        return {};
    }

    int pump(std::chrono::milliseconds wait) override {
        auto until = Clock::now() + wait;
        context_.restart();
        context_.poll();
        while (ready_.empty() && hasWork() && Clock::now() < until)
            context_.run_one_until(until);
        return deliver();
    }

    std::uint64_t sizeBytes() const override { return version_.sizeBytes; }
    std::string name() const override { return name_; }

  private:
    bool hasWork() const { return !queue_.empty() || !active_.empty(); }
    Error cancelledError() const { return {ErrorCode::cancelled, "the request was taken back", name_, ""}; }

    void enqueue(JobPtr job) {
        queue_.push_back(std::move(job));
        for (auto& worker : workers_)
            if (worker->isIdle) {
                worker->isIdle = false;
                worker->wake.cancel();
                return;
            }
        if (static_cast<int>(workers_.size()) < std::max(options_.connections, 1)) {
            workers_.push_back(std::make_unique<Worker>(context_));
            net::co_spawn(context_, serveQueue(*workers_.back()), net::detached);
        }
    }

    // Answers what is ready now, not what completions ask for meanwhile. A completion may destroy the source.
    int deliver() {
        auto alive = alive_;
        int delivered = 0;
        for (std::size_t left = ready_.size(); left > 0 && *alive && !ready_.empty(); --left, ++delivered) {
            auto [done, result] = std::move(ready_.front());
            ready_.pop_front();
            done(std::move(result));
        }
        return delivered;
    }

    net::awaitable<void> serveQueue(Worker& worker) {
        for (;;) {
            while (queue_.empty()) {
                worker.isIdle = true;
                worker.wake.expires_at(Clock::time_point::max());
                co_await worker.wake.async_wait(answered);
                worker.isIdle = false;
            }
            JobPtr job = queue_.front();
            queue_.pop_front();
            active_.push_back(job);
            Attempt attempt = co_await follow(worker, *job);
            active_.erase(std::find(active_.begin(), active_.end(), job));
            if (!job->cancelled)
                ready_.emplace_back(std::move(job->done), std::move(attempt.result));
        }
    }

    // From the address to where it redirects, if it does. What is said to be moved for good is asked for
    // there at once from then on; what is elsewhere for now may be somewhere else the next time (RFC 9110
    // §15.4).
    net::awaitable<Attempt> follow(Worker& worker, Job& job) {
        HttpUrl at = url_;
        bool isMoved = true;
        for (int hops = 0;; ++hops) {
            Connection& connection = worker.connectionTo(context_, originOf(at));
            bool reused = connection.isOpen;
            Attempt attempt = co_await fetch(connection, at, job);
            if (attempt.stale && reused && !job.cancelled)
                attempt = co_await fetch(connection, at, job);
            if (attempt.redirect == 0)
                co_return attempt;
            if (hops == maxRedirects)
                co_return Attempt{
                    networkError(cat("the server redirects more than ", maxRedirects, " times"))};
            auto next = redirectTarget(at, attempt.location, name_);
            if (!next)
                co_return Attempt{next.error()};
            if (next->isSecure && !options_.trust) {
                auto trust = TlsTrust::load();
                if (!trust)
                    co_return Attempt{trust.error()};
                options_.trust = *trust;
            }
            at = *next;
            isMoved = isMoved && isPermanentRedirect(attempt.redirect);
            if (isMoved)
                url_ = at;
        }
    }

    net::awaitable<Attempt> fetch(Connection& connection, const HttpUrl& url, Job& job) {
        if (!connection.isOpen) {
            Status connected = co_await connect(connection, url);
            if (!connected)
                co_return Attempt{connected.error()};
        }
        // Whatever goes wrong from here on, the connection is in an unknown state; only success keeps it.
        connection.isOpen = false;
        Attempt attempt;
        if (connection.tls)
            attempt = co_await exchange(connection, *connection.tls, url, job);
        else
            attempt = co_await exchange(connection, connection.stream, url, job);
        if (!connection.isOpen)
            closeNow(connection);
        co_return attempt;
    }

    net::awaitable<Status> connect(Connection& connection, const HttpUrl& url) {
        closeNow(connection);
        if (connection.endpoints.empty()) {
            Tcp::resolver resolver(context_);
            auto [error, found] = co_await resolver.async_resolve(url.host, url.port, answered);
            if (error)
                co_return networkError(cat("the host can't be found: ", error.message()));
            connection.endpoints = found;
        }
        connection.stream.expires_after(options_.connectTimeout);
        auto [error, endpoint] = co_await connection.stream.async_connect(connection.endpoints, answered);
        if (error == beast::error::timeout)
            co_return timeoutError();
        if (error) {
            connection.endpoints = {}; // the name may lead elsewhere by now
            co_return networkError(cat("can't connect: ", error.message()),
                                   "check the address, and that the server runs");
        }
        Failure ignored;
        connection.stream.socket().set_option(Tcp::no_delay(true), ignored);
        if (url.isSecure) {
            Status agreed = co_await shakeHands(connection, url);
            if (!agreed)
                co_return agreed;
        }
        connection.isOpen = true;
        co_return Status();
    }

    // Within connectTimeout, too.
    net::awaitable<Status> shakeHands(Connection& connection, const HttpUrl& url) {
        connection.tls.emplace(connection.stream, options_.trust->context());
        Failure notAnAddress, problem;
        net::ip::make_address(url.host, notAnAddress);
        if (notAnAddress) // SNI is for names (RFC 6066 §3)
            SSL_set_tlsext_host_name(connection.tls->native_handle(), url.host.c_str());
        connection.tls->set_verify_callback(net::ssl::host_name_verification(url.host), problem);
        if (problem)
            co_return networkError(cat("TLS can't be set up: ", problem.message()));
        auto [error] = co_await connection.tls->async_handshake(net::ssl::stream_base::client, answered);
        if (!error)
            co_return Status();
        long verdict = SSL_get_verify_result(connection.tls->native_handle());
        if (verdict != X509_V_OK)
            co_return networkError(
                cat("the server's certificate is not trusted: ", X509_verify_cert_error_string(verdict)),
                "check the address; certificates beside the system's come by SSL_CERT_FILE or an option");
        if (error == beast::error::timeout)
            co_return timeoutError();
        co_return networkError(cat("TLS can't be agreed on: ", error.message()),
                               "check that the address is https");
    }

    // Sends the request and reads its answer; sets `isOpen` if the connection can be used again.
    template <class ByteStream>
    net::awaitable<Attempt> exchange(Connection& connection, ByteStream& stream, const HttpUrl& url,
                                     Job& job) {
        http::request<http::empty_body> request = makeRequest(url, job.range);
        connection.stream.expires_after(options_.headerTimeout);
        if (auto [error, sent] = co_await http::async_write(stream, request, answered); error)
            co_return Attempt{readError(error), error != beast::error::timeout};

        http::response_parser<http::vector_body<std::uint8_t>> parser;
        parser.body_limit(boost::none); // judged below, before any of it is stored
        // Counted here, because Beast bounds a single line of a header, not all of it.
        for (std::size_t headerBytes = 0; !parser.is_header_done();) {
            auto [error, got] = co_await http::async_read_some(stream, connection.buffer, parser, answered);
            headerBytes += got;
            if (error)
                co_return Attempt{readError(error), !parser.got_some() && error != beast::error::timeout};
            if (headerBytes > maxHeaderBytes)
                co_return Attempt{networkError("the header of the answer has no end")};
        }

        if (isRedirect(parser.get().result_int())) {
            Attempt moved;
            moved.redirect = parser.get().result_int();
            moved.location = field(parser.get(), http::field::location);
            co_await passOver(connection, stream, parser);
            co_return moved;
        }
        bool wasPinned = version_.pinned;
        auto expected = judgeRangeAnswer(job.range, summary(parser), version_, name_);
        if (!expected)
            co_return Attempt{expected.error()};
        if (!wasPinned && options_.onVersion)
            options_.onVersion(version_);
        std::uint64_t bodyBytes = *expected;
        if (auto coding = field(parser.get(), http::field::content_encoding);
            !coding.empty() && coding != "identity")
            co_return Attempt{networkError(cat("the server sent the part encoded as \"", coding, "\""),
                                           "switch compression of .stipple files off")};
        if (auto length = parser.content_length(); length && *length != bodyBytes)
            co_return Attempt{
                networkError(cat("the server announces ", *length, " bytes for a part of ", bodyBytes))};
        parser.body_limit(bodyBytes);

        while (!parser.is_done()) {
            job.progress = {true, std::min<std::uint64_t>(bodyBytes, parser.get().body().size())};
            std::uint64_t left = bodyBytes - job.progress.bytes;
            if (job.cancelled && left > drainBytes)
                co_return Attempt{cancelledError()};
            connection.stream.expires_after(options_.noProgressTimeout);
            auto [error, got] = co_await http::async_read_some(stream, connection.buffer, parser, answered);
            if (error)
                co_return Attempt{readError(error)};
        }
        Bytes body = std::move(parser.get().body());
        if (body.size() != bodyBytes)
            co_return Attempt{
                networkError(cat("the answer ended after ", body.size(), " of ", bodyBytes, " bytes"))};
        connection.isOpen = parser.keep_alive();
        co_return Attempt{std::move(body)};
    }

    // The body of an answer that is not needed: read if it is short, so that the connection can be used
    // again.
    template <class ByteStream, class Parser>
    net::awaitable<void> passOver(Connection& connection, ByteStream& stream, Parser& parser) {
        parser.body_limit(drainBytes);
        if (auto length = parser.content_length(); length && *length > drainBytes)
            co_return;
        while (!parser.is_done()) {
            connection.stream.expires_after(options_.noProgressTimeout);
            auto [error, got] = co_await http::async_read_some(stream, connection.buffer, parser, answered);
            if (error)
                co_return;
        }
        connection.isOpen = parser.keep_alive();
    }

    http::request<http::empty_body> makeRequest(const HttpUrl& url, ByteRange range) const {
        http::request<http::empty_body> request{http::verb::get, url.target, 11};
        request.set(http::field::host, url.authority);
        if (std::string token = options_.tokenFor ? options_.tokenFor(originOf(url)) : ""; !token.empty())
            request.set(http::field::authorization, cat("Bearer ", token));
        request.set(http::field::user_agent, "stipple");
        request.set(http::field::accept_encoding, "identity");
        request.set(http::field::range, rangeField(range));
        if (version_.etag.starts_with('"')) // weak tags never match (RFC 9110 §13.1.1)
            request.set(http::field::if_match, version_.etag);
        return request;
    }

    template <class Parser>
    static RangeAnswer summary(const Parser& parser) {
        const auto& head = parser.get();
        RangeAnswer answer;
        answer.status = head.result_int();
        answer.contentRange = field(head, http::field::content_range);
        answer.etag = field(head, http::field::etag);
        answer.lastModified = field(head, http::field::last_modified);
        answer.retryAfter = retryAfterInSeconds(field(head, http::field::retry_after),
                                                field(head, http::field::date), std::time(nullptr));
        if (auto length = parser.content_length())
            answer.contentLength = *length;
        return answer;
    }

    static void closeNow(Connection& connection) {
        Failure ignored;
        connection.tls.reset();
        connection.stream.socket().close(ignored);
        connection.buffer.consume(connection.buffer.size());
        connection.isOpen = false;
    }

    Error networkError(std::string what, std::string advice = "") const {
        return {ErrorCode::networkFailed, std::move(what), name_, std::move(advice)};
    }
    Error readError(const Failure& error) const {
        if (error == beast::error::timeout)
            return timeoutError();
        if (error == http::error::end_of_stream || error == http::error::partial_message ||
            error == net::ssl::error::stream_truncated)
            return networkError("the server closed the connection in the middle of its answer", "try again");
        return networkError(cat("the connection broke: ", error.message()));
    }
    Error timeoutError() const { return noAnswerInTime(name_); }

    // Declared first, destroyed last: it owns the coroutines, which refer to all that follows but do not
    // touch it when they are destroyed.
    net::io_context context_{1};
    HttpUrl url_;
    std::string name_;
    HttpSourceOptions options_;
    FileVersion version_;
    std::vector<std::unique_ptr<Worker>> workers_;
    std::deque<JobPtr> queue_, active_;
    std::deque<std::pair<Completion, Result<Bytes>>> ready_;
    RequestId nextId_ = 0;
    bool closing_ = false;
    std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
};

} // namespace

Result<std::unique_ptr<ByteSource>> openHttpSource(const std::string& url, const HttpSourceOptions& options) {
    STIPPLE_TRY(parts, parseHttpUrl(url));
    HttpSourceOptions chosen = options;
    if (parts.isSecure && !chosen.trust) {
        STIPPLE_TRY(trust, TlsTrust::load());
        chosen.trust = trust;
    }
    return std::unique_ptr<ByteSource>(new HttpSource(std::move(parts), url, chosen));
}

Result<std::unique_ptr<ByteSource>> openSource(const std::string& pathOrUrl) {
    return looksLikeUrl(pathOrUrl) ? openHttpSource(pathOrUrl) : openFileSource(pathOrUrl);
}

} // namespace stipple
