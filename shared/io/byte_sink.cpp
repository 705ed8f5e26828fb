#include "shared/io/byte_sink.hpp"

#include "shared/base/text.hpp"
#include "shared/io/output_file.hpp"

#include <algorithm>

namespace stipple {

namespace {

class FileSink final : public ByteSink {
  public:
    explicit FileSink(std::unique_ptr<OutputFile> file) : file_(std::move(file)) {}
    bool canOverwrite() const override { return true; }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override {
        return file_->overwrite(offset, bytes);
    }
    Status finish() override { return file_->commit(); }
    std::string name() const override { return file_->path(); }

  private:
    Status put(ByteSpan bytes) override { return file_->append(bytes); }
    std::unique_ptr<OutputFile> file_;
};

} // namespace

Status ByteSink::append(ByteSpan bytes) {
    STIPPLE_CHECK(put(bytes));
    size_ += bytes.size();
    return {};
}

Status ByteSink::overwrite(std::uint64_t offset, ByteSpan) {
    return Error{ErrorCode::invalidArgument, cat("byte ", offset, " has left already"), name(), ""};
}

Result<std::unique_ptr<ByteSink>> fileSink(const std::string& path) {
    STIPPLE_TRY(file, OutputFile::create(path));
    return std::unique_ptr<ByteSink>(new FileSink(std::move(file)));
}

Status MemorySink::put(ByteSpan bytes) {
    to_.insert(to_.end(), bytes.begin(), bytes.end());
    return {};
}

Status MemorySink::overwrite(std::uint64_t offset, ByteSpan bytes) {
    if (bytes.size() > to_.size() || offset > to_.size() - bytes.size())
        return Error{ErrorCode::invalidArgument, cat("bytes from ", offset, " on are not there to overwrite"),
                     "", ""};
    std::copy(bytes.begin(), bytes.end(), to_.begin() + static_cast<std::ptrdiff_t>(offset));
    return {};
}

} // namespace stipple
