#include "converter/export/byte_sink.hpp"

#include "shared/base/text.hpp"
#include "shared/io/output_file.hpp"

#include <cerrno>
#include <cstring>
#include <unistd.h>

namespace stipple {

namespace {

class FileSink final : public ByteSink {
  public:
    explicit FileSink(std::unique_ptr<OutputFile> file) : file_(std::move(file)) {}
    Status append(ByteSpan bytes) override { return file_->append(bytes); }
    bool canOverwrite() const override { return true; }
    Status overwrite(std::uint64_t offset, ByteSpan bytes) override {
        return file_->overwrite(offset, bytes);
    }
    Status finish() override { return file_->commit(); }

  private:
    std::unique_ptr<OutputFile> file_;
};

class StandardOutputSink final : public ByteSink {
  public:
    Status append(ByteSpan bytes) override {
        while (!bytes.empty()) {
            ssize_t part = ::write(STDOUT_FILENO, bytes.data(), bytes.size());
            if (part < 0 && errno == EINTR)
                continue;
            if (part <= 0)
                return Error{ErrorCode::writeFailed, cat("can't be written: ", std::strerror(errno)),
                             "standard output", ""};
            bytes = bytes.subspan(static_cast<std::size_t>(part));
        }
        return {};
    }
    Status finish() override { return {}; }
};

} // namespace

Status ByteSink::overwrite(std::uint64_t offset, ByteSpan) {
    return Error{ErrorCode::invalidArgument, cat("byte ", offset, " has left already"), "", ""};
}

Result<std::unique_ptr<ByteSink>> fileSink(const std::string& path) {
    STIPPLE_TRY(file, OutputFile::create(path));
    return std::unique_ptr<ByteSink>(new FileSink(std::move(file)));
}

std::unique_ptr<ByteSink> standardOutputSink() {
    return std::make_unique<StandardOutputSink>();
}

} // namespace stipple
