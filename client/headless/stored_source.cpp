#include "client/headless/stored_source.hpp"

#include <utility>

namespace stipple {

namespace {

// The version that is being read; the source below finds it out.
using Stored = std::shared_ptr<std::unique_ptr<StoredRanges>>;

class StoredSource final : public ByteSource {
  public:
    StoredSource(std::unique_ptr<ByteSource> below, Stored stored, std::shared_ptr<StoredSourceCounts> counts)
        : below_(std::move(below)), stored_(std::move(stored)), counts_(std::move(counts)) {}

    // One request for what is missing, from its first byte to its last. (While the version is not known, all
    // is.)
    RequestId read(ByteRange range, Completion done) override {
        Bytes head, tail;
        if (StoredRanges* stored = stored_->get()) {
            std::uint64_t end = std::min(range.end(), below_->sizeBytes());
            range.size = end > range.offset ? end - range.offset : range.size;
            std::uint64_t before = stored->readHead(range, head);
            if (before < range.size)
                stored->readTail({range.offset + before, range.size - before}, tail);
        }
        if (counts_)
            counts_->bytesFromDisk += head.size() + tail.size();
        if (head.size() == range.size && range.size > 0) {
            if (counts_)
                ++counts_->readsFromDisk;
            done(std::move(head));
            return 0; // answered
        }
        ByteRange missing{range.offset + head.size(), range.size - head.size() - tail.size()};
        return below_->read(missing,
                            [stored = stored_, missing, head = std::move(head), tail = std::move(tail),
                             done = std::move(done)](Result<Bytes> bytes) mutable {
                                if (!bytes.ok())
                                    return done(std::move(bytes));
                                if (*stored)
                                    (*stored)->keep(missing.offset, *bytes);
                                head.insert(head.end(), bytes->begin(), bytes->end());
                                head.insert(head.end(), tail.begin(), tail.end());
                                done(std::move(head));
                            });
    }

    void cancel(RequestId id) override { below_->cancel(id); }
    bool forgetVersion() override {
        stored_->reset();
        return below_->forgetVersion();
    }
    Progress progress(RequestId id) const override { return below_->progress(id); }
    int pump(std::chrono::milliseconds wait) override { return below_->pump(wait); }
    std::uint64_t sizeBytes() const override { return below_->sizeBytes(); }
    std::string name() const override { return below_->name(); }

  private:
    std::unique_ptr<ByteSource> below_;
    Stored stored_;
    std::shared_ptr<StoredSourceCounts> counts_;
};

} // namespace

Result<std::unique_ptr<ByteSource>> openStoredSource(const std::string& url,
                                                     std::shared_ptr<RangeStore> store,
                                                     std::shared_ptr<StoredSourceCounts> counts,
                                                     HttpSourceOptions options) {
    auto stored = std::make_shared<std::unique_ptr<StoredRanges>>();
    options.onVersion = [stored, store, url](const FileVersion& version) {
        *stored = store->version(url, version);
    };
    STIPPLE_TRY(below, openHttpSource(url, options));
    return std::unique_ptr<ByteSource>(
        new StoredSource(std::move(below), std::move(stored), std::move(counts)));
}

} // namespace stipple
