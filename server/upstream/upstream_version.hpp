// One version of a file at another server, read in ranges through the cache of blocks. What it hands out is
// of this version alone: every request names it (If-Match, where its tag is strong), every answer is compared
// with it, and bytes of another one are an error. Thread: any.
#pragma once

#include "server/upstream/upstream.hpp"
#include "shared/io/byte_source.hpp"
#include "shared/io/range_answer.hpp"

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace stipple::server {

class UpstreamVersion : public std::enable_shared_from_this<UpstreamVersion> {
  public:
    // What one look at `url` found: asks for the first bytes, and takes whatever version they are of. Waits.
    // Errors: notFound, networkFailed (isTimeout()), accessDenied, unsupported (no ranges), `cancelled` by
    // `stop`.
    static Result<std::shared_ptr<UpstreamVersion>>
    find(std::shared_ptr<Upstream> upstream, const std::string& url, const std::atomic<bool>& stop);

    std::uint64_t sizeBytes() const { return file_.sizeBytes; }
    // A tag of this front's own: of the address, the upstream's tag (else its date), and the size. Strong if
    // the upstream's is.
    std::string entityTag() const;
    std::int64_t modifiedSeconds() const; // since 1970; 0: unknown

    // Whether it was seen that the upstream has another version, or none.
    bool isGone() const { return isGone_; }
    // Looks again, past the cache. Errors: `changed`, or as find().
    Status check(const std::atomic<bool>& stop);

    // Null if it is not held; doesn't wait.
    Block held(std::uint64_t index) { return upstream_->blocks.find(file_, index); }
    // Waits. Errors: `changed`; networkFailed (isTimeout()), `cancelled`.
    Result<std::vector<Block>> blocks(BlockCache::Run run, const std::atomic<bool>& stop);

    // For readers of clouds; waits inside read(). Memory: what is read, and runBlocks.
    std::unique_ptr<ByteSource> openSource();

    static constexpr std::uint64_t runBlocks = 4; // asked for at once by long reads: 1 MiB

  private:
    UpstreamVersion(std::shared_ptr<Upstream> upstream, std::string url);
    Result<Bytes> fetch(ByteRange range, const std::atomic<bool>& stop);
    Result<Bytes> fetchBlocks(ByteRange range, const std::atomic<bool>& stop);
    std::string diskKey(std::uint64_t index) const;
    Result<Bytes> fetchBy(std::unique_ptr<ByteSource> source, ByteRange range, const std::atomic<bool>& stop);
    Result<std::unique_ptr<ByteSource>> takeSource();

    const std::shared_ptr<Upstream> upstream_;
    const std::string url_;
    FileVersion version_;   // set by find() alone
    BlockCache::File file_; // likewise
    std::atomic<bool> isGone_{false};
    std::mutex mutex_;
    std::vector<std::unique_ptr<ByteSource>> spare_; // connections that are kept alive
};

} // namespace stipple::server
