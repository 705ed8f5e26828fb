#include "server/net/server.hpp"

#include "server/net/loop.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/post.hpp>
#include <csignal>

namespace stipple::server {

namespace {

constexpr std::chrono::milliseconds acceptPause{100};

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
        state_.handler = std::move(handler);
        state_.log = std::move(log);
        int cores = static_cast<int>(std::thread::hardware_concurrency());
        int threads = options.threads > 0 ? options.threads : std::clamp(cores, 1, 8);
        for (int i = 0; i < threads; ++i)
            loops_.push_back(std::make_unique<Loop>(state_));
        acceptor_ = std::make_unique<Acceptor>(loops_.front()->context());
        pause_ = std::make_unique<Timer>(loops_.front()->context());
    }

    ~BeastServer() override {
        for (auto& loop : loops_)
            loop->join();
        state_.jobs.end(); // before the loops that jobs report to
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
    int openConnections() const override { return state_.openConnections; }
    JobCounts jobCounts() const override { return state_.jobs.counts(); }

    Status reloadCertificate() override {
        if (certificatePath_.empty() && keyPath_.empty())
            return {};
        STIPPLE_TRY(loaded, TlsContext::load(certificatePath_, keyPath_));
        std::lock_guard lock(state_.tlsMutex);
        state_.tlsContext = loaded;
        return {};
    }

    void stop() override {
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
        std::unique_lock lock(state_.drainedMutex);
        return state_.drained.wait_for(lock, limit,
                                       [this] { return isClosed_ && state_.openConnections == 0; });
    }

  private:
    void stopAccepting() {
        Failure ignored;
        acceptor_->close(ignored);
        pause_->cancel();
        std::lock_guard lock(state_.drainedMutex);
        isClosed_ = true;
        state_.drained.notify_all();
    }

    // Runs on the first loop, and deals connections out to all in turn. When descriptors run out, or as many
    // connections are open as may be, it waits a moment instead of spinning; clients queue in the kernel.
    Task<void> acceptForever() {
        for (std::size_t next = 0; acceptor_->is_open();) {
            if (state_.openConnections >= state_.limits.connections) {
                co_await pause();
                continue;
            }
            Loop& loop = *loops_[next];
            auto [error, socket] = co_await acceptor_->async_accept(loop.context(), answered);
            if (error) {
                if (error != net::error::operation_aborted)
                    co_await pause();
                continue;
            }
            next = (next + 1) % loops_.size();
            ++state_.openConnections;
            net::post(loop.context(),
                      [&loop, moved = std::move(socket)]() mutable { loop.adopt(std::move(moved)); });
        }
    }

    Task<void> pause() {
        pause_->expires_after(acceptPause);
        co_await pause_->async_wait(answered);
    }

    ServerState state_;
    std::vector<std::unique_ptr<Loop>> loops_;
    std::unique_ptr<Acceptor> acceptor_; // used on the first loop once it runs
    std::unique_ptr<Timer> pause_;
    const std::string certificatePath_, keyPath_;
    Tcp::endpoint endpoint_;
    bool isClosed_ = false; // under drainedMutex
};

} // namespace

Result<std::unique_ptr<Server>> Server::start(const ServerOptions& options,
                                              std::shared_ptr<const RequestHandler> handler, RequestLog log) {
    std::signal(SIGPIPE, SIG_IGN);
    auto server = std::make_unique<BeastServer>(options, std::move(handler), std::move(log));
    STIPPLE_CHECK(server->reloadCertificate());
    STIPPLE_CHECK(server->listen(options.host, options.port));
    return std::unique_ptr<Server>(std::move(server));
}

} // namespace stipple::server
