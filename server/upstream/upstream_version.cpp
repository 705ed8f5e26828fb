#include "server/upstream/upstream_version.hpp"

#include "client/headless/http_source.hpp"
#include "server/http/entity_tag.hpp"
#include "server/http/http_date.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"

#include <algorithm>
#include <optional>

namespace stipple::server {

namespace {

constexpr std::size_t spareSources = 16;
const std::atomic<bool> neverStopped{false};

HttpSourceOptions sourceOptions(const Upstream& upstream) {
    HttpSourceOptions options;
    options.connections = 1;
    options.connectTimeout = upstream.options.connectTimeout;
    options.headerTimeout = options.noProgressTimeout = upstream.options.answerTimeout;
    options.trust = upstream.trust;
    return options;
}

Result<Bytes> readUnlessStopped(ByteSource& source, ByteRange range, const std::atomic<bool>& stop) {
    constexpr std::chrono::milliseconds untilLookingAtStop{50};
    std::optional<Result<Bytes>> answer;
    auto id = source.read(range, [&](Result<Bytes> result) { answer = std::move(result); });
    while (!answer) {
        source.pump(untilLookingAtStop);
        if (stop && !answer)
            source.cancel(id); // answered by the next pump
    }
    return std::move(*answer);
}

// Blocks are handed out as one answer to a reader.
class BlockSource final : public ByteSource {
  public:
    BlockSource(std::shared_ptr<UpstreamVersion> version, std::string name)
        : version_(std::move(version)), name_(std::move(name)) {}

    RequestId read(ByteRange range, Completion done) override {
        done(readRange(range));
        return 0;
    }
    std::uint64_t sizeBytes() const override { return version_->sizeBytes(); }
    std::string name() const override { return name_; }

  private:
    Result<Bytes> readRange(ByteRange range) const {
        Bytes bytes;
        if (range.size == 0)
            return bytes;
        if (range.offset >= sizeBytes())
            return Error{ErrorCode::truncated, "the file ends before the bytes asked for", name_, ""};
        range.size = std::min(range.size, sizeBytes() - range.offset);
        auto run = BlockCache::blocksOf(range);
        for (std::uint64_t at = 0; at < run.count; at += UpstreamVersion::runBlocks) {
            std::uint64_t count = std::min(UpstreamVersion::runBlocks, run.count - at);
            auto blocks = version_->blocks({run.first + at, count}, neverStopped);
            if (!blocks)
                return blocks.error().at(name_);
            for (std::uint64_t i = 0; i < count; ++i)
                append(bytes, range, run.first + at + i,
                       **(blocks->begin() + static_cast<std::ptrdiff_t>(i)));
        }
        return bytes;
    }

    static void append(Bytes& bytes, ByteRange range, std::uint64_t index, const Bytes& block) {
        std::uint64_t begin = index * BlockCache::blockBytes, end = begin + block.size();
        auto from = static_cast<std::ptrdiff_t>(std::max(begin, range.offset) - begin);
        auto to = static_cast<std::ptrdiff_t>(std::min(end, range.end()) - begin);
        bytes.insert(bytes.end(), block.begin() + from, block.begin() + to);
    }

    std::shared_ptr<UpstreamVersion> version_;
    std::string name_;
};

} // namespace

UpstreamVersion::UpstreamVersion(std::shared_ptr<Upstream> upstream, std::string url)
    : upstream_(std::move(upstream)), url_(std::move(url)) {}

Result<std::shared_ptr<UpstreamVersion>> UpstreamVersion::find(std::shared_ptr<Upstream> upstream,
                                                               const std::string& url,
                                                               const std::atomic<bool>& stop) {
    std::shared_ptr<UpstreamVersion> found(new UpstreamVersion(upstream, url));
    HttpSourceOptions options = sourceOptions(*upstream);
    options.onVersion = [version = &found->version_](const FileVersion& first) { *version = first; };
    STIPPLE_TRY(source, openHttpSource(url, options));
    if (auto bytes = found->fetchBy(std::move(source), {0, fileHeaderBytes}, stop); !bytes)
        return bytes.error();
    if (found->version_.sizeBytes == 0)
        return Error{ErrorCode::unsupported, "the server does not say how large the file is", url, ""};
    found->file_ = {upstream->nextFileNumber(), found->version_.sizeBytes};
    return found;
}

std::string UpstreamVersion::entityTag() const {
    const std::string& theirs = version_.etag.empty() ? version_.lastModified : version_.etag;
    std::string tag = tagOfText(cat(url_, "\n", theirs, "\n", version_.sizeBytes));
    return version_.etag.starts_with('"') ? tag : cat("W/", tag);
}

std::int64_t UpstreamVersion::modifiedSeconds() const {
    return parseHttpDate(version_.lastModified, 0).value_or(0);
}

Status UpstreamVersion::check(const std::atomic<bool>& stop) {
    auto bytes = fetch({0, fileHeaderBytes}, stop);
    return bytes ? Status() : Status(bytes.error());
}

Result<std::vector<Block>> UpstreamVersion::blocks(BlockCache::Run run, const std::atomic<bool>& stop) {
    if (isGone_) // also of what is held: who began with the old version must not end with it unawares
        return Error{ErrorCode::changed, "the file was replaced at the server that it comes from", "", ""};
    return upstream_->blocks.get(
        file_, run, [this, &stop](ByteRange range) { return fetch(range, stop); }, stop);
}

std::unique_ptr<ByteSource> UpstreamVersion::openSource() {
    return std::make_unique<BlockSource>(shared_from_this(), url_.substr(0, url_.find('?')));
}

Result<Bytes> UpstreamVersion::fetch(ByteRange range, const std::atomic<bool>& stop) {
    STIPPLE_TRY(source, takeSource());
    return fetchBy(std::move(source), range, stop);
}

Result<std::unique_ptr<ByteSource>> UpstreamVersion::takeSource() {
    {
        std::lock_guard lock(mutex_);
        if (!spare_.empty()) {
            auto source = std::move(spare_.back());
            spare_.pop_back();
            return source;
        }
    }
    HttpSourceOptions options = sourceOptions(*upstream_);
    options.version = version_;
    return openHttpSource(url_, options);
}

// The source is used again only after a success.
Result<Bytes> UpstreamVersion::fetchBy(std::unique_ptr<ByteSource> source, ByteRange range,
                                       const std::atomic<bool>& stop) {
    UpstreamCounts& counts = upstream_->counts;
    ++counts.requests;
    Result<Bytes> bytes = readUnlessStopped(*source, range, stop);
    if (bytes) {
        counts.bytes += bytes->size();
        std::lock_guard lock(mutex_);
        if (spare_.size() < spareSources)
            spare_.push_back(std::move(source));
        return bytes;
    }
    const Error& error = bytes.error();
    if (error.code == ErrorCode::changed && !isGone_.exchange(true))
        ++counts.changes;
    if (error.code != ErrorCode::changed && error.code != ErrorCode::cancelled)
        ++counts.failures;
    if (isTimeout(error))
        ++counts.timeouts;
    return bytes;
}

} // namespace stipple::server
