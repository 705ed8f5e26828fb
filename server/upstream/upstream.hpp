// What all clouds from elsewhere share: options, the cache of blocks, whom https believes, and counts. Lives
// as long as the server. Thread: any.
#pragma once

#include "server/http/measurement.hpp"
#include "server/upstream/block_cache.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace stipple {
class TlsTrust;
}

namespace stipple::server {

struct UpstreamOptions {
    std::uint64_t cacheBytes = 256u << 20; // of blocks, of all clouds
    // A version that was found at most so long ago is answered without asking again whether it is the one.
    std::chrono::milliseconds freshFor{10'000};
    std::chrono::milliseconds retryPause{2'000};     // from a failed look at an upstream to the next
    std::chrono::milliseconds connectTimeout{5'000}; // with the handshake of TLS
    std::chrono::milliseconds answerTimeout{15'000}; // of an answer's header, and of each piece of a body
    std::string caPath; // PEM of the certificates to believe; empty: the system's
};

struct UpstreamCounts {
    std::atomic<std::uint64_t> requests{0}, bytes{0}; // of ranges that were asked for
    std::atomic<std::uint64_t> failures{0}, timeouts{0};
    std::atomic<std::uint64_t> changes{0}; // of versions that were found to be gone
};

class Upstream {
  public:
    // Errors: those of TlsTrust::load.
    static Result<std::shared_ptr<Upstream>> open(const UpstreamOptions& options);

    const UpstreamOptions options;
    const std::shared_ptr<TlsTrust> trust;
    BlockCache blocks;
    UpstreamCounts counts;

    std::uint64_t nextFileNumber() { return ++fileNumbers_; } // of BlockCache::File
    std::vector<Measurement> measurements() const;

  private:
    Upstream(const UpstreamOptions& chosen, std::shared_ptr<TlsTrust> trusted)
        : options(chosen), trust(std::move(trusted)), blocks(chosen.cacheBytes) {}
    std::atomic<std::uint64_t> fileNumbers_{0};
};

} // namespace stipple::server
