#include "shared/io/file_source.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace stipple {

namespace {

class FileSource final : public ByteSource {
  public:
    FileSource(int descriptor, const struct stat& opened, std::string path)
        : descriptor_(descriptor), opened_(opened), path_(std::move(path)) {}
    ~FileSource() override { ::close(descriptor_); }

    RequestId read(ByteRange range, Completion done) override {
        RequestId id = ++next_;
        done(readRange(range));
        return id;
    }
    std::uint64_t sizeBytes() const override { return static_cast<std::uint64_t>(opened_.st_size); }
    std::string name() const override { return path_; }

  private:
    Result<Bytes> readRange(ByteRange range) {
        struct stat now {};
        if (::fstat(descriptor_, &now) != 0)
            return failure();
        if (now.st_size != opened_.st_size || now.st_mtim.tv_sec != opened_.st_mtim.tv_sec ||
            now.st_mtim.tv_nsec != opened_.st_mtim.tv_nsec)
            return Error{ErrorCode::changed, say("the file was changed while it was open"), path_,
                         say("open it again")};
        std::uint64_t size = sizeBytes();
        if (range.offset > size || (range.offset == size && range.size > 0))
            return Error{ErrorCode::truncated,
                         say("byte ", range.offset, " was asked for, but the file has only ", size), path_,
                         ""};
        Bytes bytes(static_cast<std::size_t>(std::min(range.size, size - range.offset)));
        std::size_t got = 0;
        while (got < bytes.size()) {
            ssize_t part = ::pread(descriptor_, bytes.data() + got, bytes.size() - got,
                                   static_cast<off_t>(range.offset + got));
            if (part < 0 && errno == EINTR)
                continue;
            if (part < 0)
                return failure();
            if (part == 0)
                return Error{ErrorCode::changed, say("the file became shorter while it was read"), path_, ""};
            got += static_cast<std::size_t>(part);
        }
        return bytes;
    }
    Error failure() const {
        return {ErrorCode::ioFailed, say("can't be read: ", std::strerror(errno)), path_, ""};
    }

    int descriptor_;
    struct stat opened_;
    std::string path_;
    RequestId next_ = 0;
};

Error cantOpen(const std::string& path, int reason) {
    const char* advice = reason == ENOENT   ? "check the name"
                         : reason == EACCES ? "ask for permission to read it"
                                            : "";
    return {reason == ENOENT ? ErrorCode::notFound : ErrorCode::ioFailed,
            say("can't be opened: ", std::strerror(reason)), path, advice};
}

} // namespace

Result<std::unique_ptr<ByteSource>> openFileSource(const std::string& path) {
    // O_NONBLOCK: opening a FIFO must not wait for a writer.
    int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        return cantOpen(path, errno);
    struct stat opened {};
    if (::fstat(descriptor, &opened) != 0 || !S_ISREG(opened.st_mode)) {
        ::close(descriptor);
        return Error{ErrorCode::invalidArgument, say("is not a regular file"), path, ""};
    }
    return std::unique_ptr<ByteSource>(new FileSource(descriptor, opened, path));
}

} // namespace stipple
