#include "converter/input/input_file.hpp"

#include "shared/io/file_source.hpp"

namespace stipple {

namespace {
class StoppableSource final : public ByteSource {
  public:
    StoppableSource(std::unique_ptr<ByteSource> source, const std::atomic<bool>& stop)
        : source_(std::move(source)), stop_(stop) {}

    RequestId read(ByteRange range, Completion done) override {
        if (!stop_)
            return source_->read(range, std::move(done));
        done(Error{ErrorCode::cancelled, "interrupted", "", ""});
        return 0;
    }
    void cancel(RequestId request) override { source_->cancel(request); }
    int pump(std::chrono::milliseconds wait) override { return source_->pump(wait); }
    std::uint64_t sizeBytes() const override { return source_->sizeBytes(); }
    std::string name() const override { return source_->name(); }

  private:
    std::unique_ptr<ByteSource> source_;
    const std::atomic<bool>& stop_;
};
} // namespace

Result<std::unique_ptr<ByteSource>> openInputFile(const std::string& path, const std::atomic<bool>* stop) {
    STIPPLE_TRY(source, openFileSource(path));
    if (!stop)
        return std::move(source);
    return std::unique_ptr<ByteSource>(std::make_unique<StoppableSource>(std::move(source), *stop));
}

} // namespace stipple
