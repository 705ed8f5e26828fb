// The server's sockets: accepts connections, reads requests, hands them to a handler, sends the answers.
//
// Threads: one event loop a thread; a connection stays on its loop, so nothing of it is locked. The calls
// here may come from any thread.
//
// Memory of a connection: its request header (at most 16 KiB), and 68 KiB from its loop's pool while it
// sends, through TLS also while its client is behind. Nothing grows with a file's size.
//
// The process ignores SIGPIPE from the first server on: a client that leaves must not end the program.
#pragma once

#include "server/http/handler.hpp"
#include "server/jobs/job_pool.hpp"
#include "server/net/request_log.hpp"
#include "shared/base/result.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stipple::server {

struct ServerLimits {
    // Open at once; further clients wait in the listen queue, and idle connections are closed for them. Never
    // more than the system's limit on descriptors leaves room for beside files.
    int connections = 4096;
    int connectionsPerClient = 512; // of one address, IPv6: of one /64; more are closed at once
    std::size_t requestHeaderBytes = 16 * 1024;
    std::chrono::milliseconds idle{60'000}; // from one answer to the next request's first byte
    // From a request's first byte to the end of its header; also for the handshake of TLS.
    std::chrono::milliseconds header{10'000};
    // For each progressBytes of an answer, or what is left of it, to leave: 8.7 kB/s at least.
    std::chrono::milliseconds noProgress{30'000};
    static constexpr std::size_t progressBytes = 256 * 1024;
    std::chrono::milliseconds sweep{250}; // how often the limits are looked at
    JobLimits jobs;
    // Of jobs that wait for another server (Job::isTransfer): each holds a thread, but no core. How long they
    // take is limited by that server's and the client's own limits.
    JobLimits transfers{32, 1024, 256, std::chrono::hours(24), std::chrono::milliseconds(30'000)};
};

// Who may read /metrics, which names every cloud that was asked for, private ones, too.
enum class MetricsFor {
    nobody,
    thisMachine, // clients with a loopback address, but not what a proxy says it passes on
    everyone,
};

struct ServerOptions {
    std::string host = "127.0.0.1"; // address or name; loopback: nobody else can connect
    std::uint16_t port = 0;         // 0: any free one
    int threads = 0;                // 0: one for each core, at most 8
    // Proxies whose X-Forwarded-For is believed, and whose connections are not limited; addresses.
    std::vector<std::string> trustedProxies;
    std::string certificatePath, keyPath; // PEM; both: https, neither: http
    MetricsFor metrics = MetricsFor::nobody;
    ServerLimits limits;
};

class Server {
  public:
    // Binds, listens and runs. Errors: networkFailed (the host is none of this machine's, the port is taken);
    // invalidArgument (a trusted proxy is no address);
    // what TlsContext::load says of certificate and key.
    static Result<std::unique_ptr<Server>>
    start(const ServerOptions& options, std::shared_ptr<const RequestHandler> handler, RequestLog log);
    // Cuts what still runs and waits for the threads.
    virtual ~Server() = default;

    virtual std::uint16_t port() const = 0;
    virtual std::string address() const = 0; // "http://127.0.0.1:8017/", or https
    virtual int openConnections() const = 0;
    virtual JobCounts jobCounts() const = 0;

    // Reads certificate and key again, for connections to come; those that are open keep theirs, and where
    // the files can't be used, so does everything.
    virtual Status reloadCertificate() = 0;

    // What may come before the first step: /healthz says 503, so that whoever deals out requests stops
    // sending them here, and every answer is the last of its connection; new ones are still accepted.
    virtual void announceEnd() = 0;
    // First step of ending: accepts nothing more, closes idle connections, lets answers finish.
    virtual void stop() = 0;
    // Second step: closes everything.
    virtual void cut() = 0;
    // True once stopped and no connection is left; waits up to `limit` for that.
    virtual bool waitUntilDrained(std::chrono::milliseconds limit) = 0;
};

} // namespace stipple::server
