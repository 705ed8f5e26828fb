#include "converter/input/file_cursor.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

Result<ByteSpan> FileCursor::peek(std::size_t count) {
    std::size_t held = block_.size() - at_;
    if (held < count && offset_ + held < source_.sizeBytes()) {
        STIPPLE_TRY(more, source_.read({offset_ + held, std::max(count, blockBytes_) - held}));
        if (held == 0) {
            block_ = std::move(more);
        } else {
            block_.erase(block_.begin(), block_.begin() + static_cast<std::ptrdiff_t>(at_));
            block_.insert(block_.end(), more.begin(), more.end());
        }
        at_ = 0;
    }
    return ByteSpan(block_).subspan(at_);
}

void FileCursor::skip(std::uint64_t count) {
    std::size_t held = block_.size() - at_;
    if (count < held) {
        at_ += static_cast<std::size_t>(count);
    } else {
        block_.clear();
        at_ = 0;
    }
    offset_ += count;
}

Result<std::string> FileCursor::line(std::size_t mostBytes) {
    STIPPLE_TRY(bytes, peek(mostBytes + 2));
    std::size_t length = 0, end = std::min(bytes.size(), mostBytes);
    while (length < end && bytes[length] != '\n' && bytes[length] != '\r')
        ++length;
    if (length == mostBytes)
        return Error{ErrorCode::corrupt, cat("a line of the header is longer than ", mostBytes, " bytes"),
                     cat(source_.name(), ", byte ", offset_), "the file is damaged, or of another kind"};
    std::string text(reinterpret_cast<const char*>(bytes.data()), length);
    bool carriageReturn = length < bytes.size() && bytes[length] == '\r';
    std::size_t ending = length < bytes.size() ? 1 : 0;
    if (carriageReturn && length + 1 < bytes.size() && bytes[length + 1] == '\n')
        ending = 2;
    skip(length + ending);
    return text;
}

} // namespace stipple
