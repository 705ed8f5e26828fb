#include "server/files/open_file_source.hpp"

#include <algorithm>

namespace stipple::server {

namespace {

class OpenFileSource final : public ByteSource {
  public:
    OpenFileSource(std::shared_ptr<const OpenFile> file, std::string name)
        : file_(std::move(file)), name_(std::move(name)) {}

    RequestId read(ByteRange range, Completion done) override {
        done(readRange(range));
        return 0;
    }
    std::uint64_t sizeBytes() const override { return file_->identity().sizeBytes; }
    std::string name() const override { return name_; }

  private:
    Result<Bytes> readRange(ByteRange range) const {
        if (range.size == 0)
            return Bytes();
        if (range.offset >= sizeBytes())
            return Error{ErrorCode::truncated, "the file ends before the bytes asked for", name_, ""};
        Bytes bytes(static_cast<std::size_t>(std::min(range.size, sizeBytes() - range.offset)));
        bool isRead = file_->readAt(range.offset, bytes.data(), bytes.size());
        if (!file_->isUnchanged())
            return Error{ErrorCode::changed, "the file has changed since it was opened", name_, ""};
        if (!isRead)
            return Error{ErrorCode::ioFailed, "the file can't be read", name_, ""};
        return bytes;
    }

    std::shared_ptr<const OpenFile> file_;
    std::string name_;
};

} // namespace

std::unique_ptr<ByteSource> sourceOver(std::shared_ptr<const OpenFile> file, std::string name) {
    return std::make_unique<OpenFileSource>(std::move(file), std::move(name));
}

} // namespace stipple::server
