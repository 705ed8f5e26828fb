#include "server/files/scratch_space.hpp"

#include "shared/base/text.hpp"
#include "shared/io/scratch_file.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>

namespace stipple::server {

ScratchSpace::ScratchSpace(std::string folder, std::uint64_t maxBytes)
    : folder_(std::move(folder)), maxBytes_(maxBytes) {}

ScratchSpace::Share::~Share() {
    space_->used_ -= bytes_;
}

bool ScratchSpace::Share::grow(std::uint64_t bytes) {
    std::uint64_t before = space_->used_.fetch_add(bytes);
    if (bytes > space_->maxBytes_ || before > space_->maxBytes_ - bytes) {
        space_->used_ -= bytes;
        return false;
    }
    bytes_ += bytes;
    return true;
}

ScratchSink::ScratchSink(std::unique_ptr<ScratchFile> file, std::shared_ptr<ScratchSpace> space)
    : file_(std::move(file)), share_(std::make_shared<ScratchSpace::Share>(std::move(space))) {}

ScratchSink::~ScratchSink() = default;

Result<std::unique_ptr<ScratchSink>> ScratchSink::open(std::shared_ptr<ScratchSpace> space) {
    STIPPLE_TRY(file, ScratchFile::createNameless(space->folder()));
    return std::unique_ptr<ScratchSink>(new ScratchSink(std::move(file), std::move(space)));
}

Status ScratchSink::put(ByteSpan bytes) {
    if (!share_->grow(bytes.size()))
        return Error{ErrorCode::limitExceeded, ScratchSpace::noRoomText, "", ""};
    return file_->write(file_->reserve(bytes.size()), bytes);
}

Status ScratchSink::overwrite(std::uint64_t offset, ByteSpan bytes) {
    if (bytes.size() > sizeBytes() || offset > sizeBytes() - bytes.size())
        return Error{ErrorCode::invalidArgument, cat("bytes from ", offset, " on are not there to overwrite"),
                     name(), ""};
    return file_->write(offset, bytes);
}

Status ScratchSink::finish() {
    int descriptor = ::fcntl(file_->descriptor(), F_DUPFD_CLOEXEC, 0);
    if (descriptor < 0)
        return Error{ErrorCode::writeFailed, cat("can't be sent: ", std::strerror(errno)), name(), ""};
    STIPPLE_TRY(file, OpenFile::adopt(descriptor, name()));
    struct Kept {
        std::shared_ptr<const OpenFile> file;
        std::shared_ptr<ScratchSpace::Share> share;
    };
    auto kept = std::make_shared<Kept>(Kept{file, share_});
    *place_ = std::shared_ptr<const OpenFile>(kept, kept->file.get());
    return {};
}

} // namespace stipple::server
