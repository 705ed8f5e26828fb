#include "server/net/server.hpp"

#include "server/net/client_address.hpp"
#include "server/net/loop.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <csignal>
#include <sys/resource.h>

namespace stipple::server {

namespace {

constexpr std::chrono::milliseconds acceptPause{100};
constexpr int acceptedInTurn = 64; // connections, before the loop goes on with its answers
// A connection that has been idle for this long is closed when others wait for a place.
constexpr std::chrono::milliseconds evenIfFull{1000};
// Descriptors that connections leave to files, event loops and whatever libraries open.
constexpr rlim_t spareDescriptors = 128;

// Of `wanted` connections, those that the system has descriptors for: one each, and perhaps a file each.
int affordableConnections(int wanted) {
    struct rlimit limit {};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return wanted;
    rlim_t spare = std::min(spareDescriptors, limit.rlim_cur / 4);
    return static_cast<int>(std::min<rlim_t>(static_cast<rlim_t>(wanted), limit.rlim_cur - spare));
}

Result<Tcp::endpoint> resolve(const std::string& host, std::uint16_t port) {
    Failure problem;
    auto address = net::ip::make_address(host, problem);
    if (!problem)
        return Tcp::endpoint(address, port);
    net::io_context context;
    auto found = Tcp::resolver(context).resolve(host, std::to_string(port), Tcp::resolver::passive, problem);
    if (problem || found.empty())
        return Error{ErrorCode::networkFailed, cat("the host can't be found: ", problem.message()), host,
                     "use an address of this machine, such as 127.0.0.1 or 0.0.0.0"};
    return found.begin()->endpoint();
}

class BeastServer final : public Server {
  public:
    BeastServer(const ServerOptions& options, std::shared_ptr<const RequestHandler> handler, RequestLog log)
        : state_(options.limits), certificatePath_(options.certificatePath), keyPath_(options.keyPath) {
        state_.limits.connections = affordableConnections(options.limits.connections);
        state_.handler = std::move(handler);
        state_.log = std::move(log);
        state_.metricsFor = options.metrics;
        int cores = static_cast<int>(std::thread::hardware_concurrency());
        int threads = options.threads > 0 ? options.threads : std::clamp(cores, 1, 8);
        for (int i = 0; i < threads; ++i)
            loops_.push_back(std::make_unique<Loop>(state_));
        for (auto& loop : loops_)
            state_.metrics.push_back(&loop->metrics());
        acceptor_ = std::make_unique<Acceptor>(loops_.front()->context());
        pause_ = std::make_unique<Timer>(loops_.front()->context());
    }

    ~BeastServer() override {
        for (auto& loop : loops_)
            loop->join();
        state_.jobs.end(); // before the loops that jobs report to
        state_.transfers.end();
    }

    Status trust(const std::vector<std::string>& proxies) {
        for (const std::string& proxy : proxies) {
            Failure problem;
            state_.trustedProxies.push_back(net::ip::make_address(proxy, problem));
            if (problem)
                return Error{ErrorCode::invalidArgument, "a trusted proxy is named by its IP address", proxy,
                             "write, for example, 127.0.0.1"};
        }
        return {};
    }

    Status listen(const std::string& host, std::uint16_t port) {
        STIPPLE_TRY(endpoint, resolve(host, port));
        Failure problem;
        acceptor_->open(endpoint.protocol(), problem);
        if (!problem)
            acceptor_->set_option(Acceptor::reuse_address(true), problem);
        if (!problem)
            acceptor_->bind(endpoint, problem);
        if (!problem)
            acceptor_->non_blocking(true, problem);
        if (!problem)
            acceptor_->listen(net::socket_base::max_listen_connections, problem);
        if (problem)
            return Error{ErrorCode::networkFailed, cat("can't listen: ", problem.message()),
                         cat(host, " port ", port),
                         problem == net::error::address_in_use
                             ? "another program uses the port: choose one with --port, 0 for any free one"
                             : ""};
        endpoint_ = acceptor_->local_endpoint(problem);
        net::co_spawn(loops_.front()->context(), acceptForever(), net::detached);
        return {};
    }

    std::uint16_t port() const override { return endpoint_.port(); }
    std::string address() const override {
        auto address = endpoint_.address();
        std::string host = address.to_string();
        if (address.is_unspecified()) // listening everywhere is no address to go to
            host = address.is_v6() ? "::1" : "127.0.0.1";
        const char* scheme = certificatePath_.empty() ? "http" : "https";
        return address.is_v6() ? cat(scheme, "://[", host, "]:", port(), "/")
                               : cat(scheme, "://", host, ":", port(), "/");
    }
    int openConnections() const override { return state_.connections.all(); }
    JobCounts jobCounts() const override { return state_.jobs.counts(); }

    Status reloadCertificate() override {
        if (certificatePath_.empty() && keyPath_.empty())
            return {};
        STIPPLE_TRY(loaded, TlsContext::load(certificatePath_, keyPath_));
        std::lock_guard lock(state_.tlsMutex);
        state_.tlsContext = loaded;
        return {};
    }

    void announceEnd() override { state_.isEnding = true; }
    void stop() override {
        announceEnd();
        net::post(loops_.front()->context(), [this] { stopAccepting(); });
        for (auto& loop : loops_)
            loop->stop();
    }
    void cut() override {
        net::post(loops_.front()->context(), [this] { stopAccepting(); });
        for (auto& loop : loops_)
            loop->cut();
    }
    bool waitUntilDrained(std::chrono::milliseconds limit) override {
        return state_.connections.waitUntilNone(limit);
    }

  private:
    void stopAccepting() {
        Failure ignored;
        acceptor_->close(ignored);
        pause_->cancel();
        state_.connections.close();
    }

    // Runs on the first loop, and deals connections out to all in turn. When descriptors run out, or as many
    // connections are open as may be, it waits a moment instead of spinning; clients queue in the kernel.
    Task<void> acceptForever() {
        while (acceptor_->is_open()) {
            if (isFull()) {
                for (auto& loop : loops_)
                    loop->closeIdle(evenIfFull);
                co_await pause();
                continue;
            }
            auto [error] = co_await acceptor_->async_wait(Acceptor::wait_read, answered);
            if (!error)
                error = acceptWaiting();
            if (error && error != net::error::operation_aborted) {
                if (error == net::error::no_descriptors)
                    state_.handler->spareDescriptors();
                co_await pause();
            }
        }
    }

    bool isFull() const { return state_.connections.all() >= state_.limits.connections; }

    // Lets in those that wait already. One at a time would be one for each round of the loop's answers, and a
    // thousand clients that come at once wait for a thousand rounds.
    Failure acceptWaiting() {
        for (int i = 0; i < acceptedInTurn && !isFull(); ++i) {
            Failure error;
            Loop& loop = *loops_[nextLoop_];
            Socket socket = acceptor_->accept(loop.context(), error);
            if (error == net::error::would_block)
                return {};
            if (error == net::error::connection_aborted)
                continue;
            if (error)
                return error;
            nextLoop_ = (nextLoop_ + 1) % loops_.size();
            dealOut(loop, std::move(socket));
        }
        return {};
    }

    void dealOut(Loop& loop, Socket socket) {
        Failure problem;
        auto peer = socket.remote_endpoint(problem).address();
        const auto& trusted = state_.trustedProxies;
        bool isTrusted = std::find(trusted.begin(), trusted.end(), peer) != trusted.end();
        std::string group = problem || isTrusted ? "" : clientGroup(peer);
        int limit = group.empty() ? state_.limits.connections : state_.limits.connectionsPerClient;
        if (!state_.connections.add(group, limit)) {
            socket.set_option(net::socket_base::linger(true, 0), problem); // closed by a reset: costs nothing
            return;
        }
        net::post(loop.context(), [&loop, moved = std::move(socket), group]() mutable {
            loop.adopt(std::move(moved), std::move(group));
        });
    }

    Task<void> pause() {
        pause_->expires_after(acceptPause);
        co_await pause_->async_wait(answered);
    }

    ServerState state_;
    std::vector<std::unique_ptr<Loop>> loops_;
    std::unique_ptr<Acceptor> acceptor_; // used on the first loop once it runs
    std::size_t nextLoop_ = 0;           // that gets the next connection
    std::unique_ptr<Timer> pause_;
    const std::string certificatePath_, keyPath_;
    Tcp::endpoint endpoint_;
};

} // namespace

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options,
                                              std::shared_ptr<const RequestHandler> handler, RequestLog log) {
    std::signal(SIGPIPE, SIG_IGN);
    auto server = std::make_unique<BeastServer>(options, std::move(handler), std::move(log));
    STIPPLE_CHECK(server->reloadCertificate());
    STIPPLE_CHECK(server->trust(options.trustedProxies));
    STIPPLE_CHECK(server->listen(options.host, options.port));
    return std::unique_ptr<Server>(std::move(server));
}

} // namespace stipple::server
