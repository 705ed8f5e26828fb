#include "server/upstream/upstream_version.hpp"

#include "client/headless/http_source.hpp"
#include "server/http/entity_tag.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/http_date.hpp"

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
    options.tokenFor = [&upstream](const std::string& origin) { return upstream.tokenFor(origin); };
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
        file_, run, [this, &stop](ByteRange range) { return fetchBlocks(range, stop); }, stop);
}

// Only a strong tag tells for certain, also after a restart, that bytes are of this version.
std::string UpstreamVersion::diskKey(std::uint64_t index) const {
    return cat(url_, "\n", version_.etag, "\n", version_.sizeBytes, "\n", index);
}

// A run of whole blocks: those that are on disk from there, the others, neighbours in one request, from the
// upstream.
Result<Bytes> UpstreamVersion::fetchBlocks(ByteRange range, const std::atomic<bool>& stop) {
    DiskBlocks* disk = upstream_->disk.get();
    if (disk == nullptr || !version_.etag.starts_with('"'))
        return fetch(range, stop);
    auto run = BlockCache::blocksOf(range);
    auto partOf = [&](std::uint64_t first, std::uint64_t count) -> ByteRange {
        std::uint64_t begin = first * BlockCache::blockBytes;
        return {begin, std::min(count * BlockCache::blockBytes, range.end() - begin)};
    };
    std::vector<std::optional<Bytes>> held;
    for (std::uint64_t i = 0; i < run.count; ++i) {
        held.push_back(disk->find(diskKey(run.first + i)));
        if (held.back() && held.back()->size() != partOf(run.first + i, 1).size)
            held.back().reset();
    }
    Bytes all;
    for (std::uint64_t i = 0; i < run.count;) {
        if (held[i]) {
            all.insert(all.end(), held[i]->begin(), held[i]->end());
            ++i;
            continue;
        }
        std::uint64_t count = 1;
        while (i + count < run.count && !held[i + count])
            ++count;
        STIPPLE_TRY(bytes, fetch(partOf(run.first + i, count), stop));
        for (std::uint64_t k = 0; k < count; ++k) {
            ByteRange part = partOf(run.first + i + k, 1);
            std::size_t at = static_cast<std::size_t>(k * BlockCache::blockBytes);
            if (at + part.size <= bytes.size()) // else the caller refuses the run
                disk->keep(diskKey(run.first + i + k),
                           ByteSpan(bytes).subspan(at, static_cast<std::size_t>(part.size)));
        }
        all.insert(all.end(), bytes.begin(), bytes.end());
        i += count;
    }
    return all;
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
