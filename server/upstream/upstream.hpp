// What all clouds from elsewhere share: options, the caches of blocks, whom https believes, tokens, and
// counts. Lives as long as the server. Thread: any.
#pragma once

#include "server/http/measurement.hpp"
#include "server/upstream/block_cache.hpp"
#include "server/upstream/disk_blocks.hpp"
#include "server/upstream/upstream_tokens.hpp"
#include "shared/base/result.hpp"

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
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
    std::string caPath;     // PEM of the certificates to believe; empty: the system's
    std::string tokenPath;  // of UpstreamTokens; empty: none
    std::string diskFolder; // of DiskBlocks; empty: nothing is kept on disk
    std::uint64_t diskBytes = 16ull << 30;
};

struct UpstreamCounts {
    std::atomic<std::uint64_t> requests{0}, bytes{0}; // of ranges that were asked for
    std::atomic<std::uint64_t> failures{0}, timeouts{0};
    std::atomic<std::uint64_t> changes{0}; // of versions that were found to be gone
};

class Upstream {
  public:
    // Errors: those of TlsTrust::load, UpstreamTokens::load and DiskBlocks::open.
    static Result<std::shared_ptr<Upstream>> open(const UpstreamOptions& options);

    const UpstreamOptions options;
    const std::shared_ptr<TlsTrust> trust;
    BlockCache blocks;
    const std::unique_ptr<DiskBlocks> disk; // null: none
    UpstreamCounts counts;

    // For an origin as originOf() writes it; empty: none.
    std::string tokenFor(const std::string& origin) const;
    // Reads the file of tokens again; where that fails, the old ones stay in use.
    Status reloadTokens();

    std::uint64_t nextFileNumber() { return ++fileNumbers_; } // of BlockCache::File
    std::vector<Measurement> measurements() const;

  private:
    Upstream(const UpstreamOptions& chosen, std::shared_ptr<TlsTrust> trusted,
             std::unique_ptr<DiskBlocks> kept)
        : options(chosen), trust(std::move(trusted)), blocks(chosen.cacheBytes), disk(std::move(kept)) {}
    std::atomic<std::uint64_t> fileNumbers_{0};
    mutable std::mutex tokensMutex_;
    UpstreamTokens tokens_;
};

} // namespace stipple::server
