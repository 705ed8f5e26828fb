#include "converter/input/text_lines.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cstring>

namespace stipple {

namespace {
constexpr std::size_t blockBytes = std::size_t{1} << 20;
}

Result<bool> TextLines::load() {
    if (at_ != linesEnd_)
        return true;
    return refill();
}

Result<bool> TextLines::refill() {
    std::string rest;
    if (at_ != nullptr)
        rest.assign(at_, static_cast<std::size_t>(end_ - at_));
    for (;;) {
        STIPPLE_TRY(bytes, source_.read({fileOffset_, blockBytes}));
        fileOffset_ += bytes.size();
        block_ = std::move(rest);
        block_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
        const bool fileEnds = bytes.empty();
        // A '\r' alone ends a line; one before '\n' is a blank. The last byte may have its '\n' behind it.
        if (std::memchr(block_.data(), '\n', block_.size()) == nullptr) {
            for (std::size_t i = 0; i + 1 < block_.size(); ++i)
                if (block_[i] == '\r' && block_[i + 1] != '\n')
                    block_[i] = '\n';
        }
        const std::size_t size = block_.size();
        if (fileEnds) {
            if (size == 0) {
                at_ = linesEnd_ = end_ = nullptr;
                return false;
            }
            block_ += '\n';
        }
        std::size_t last = block_.rfind('\n');
        if (last != std::string::npos) {
            at_ = block_.data();
            linesEnd_ = at_ + last + 1;
            end_ = at_ + size;
            if (fileEnds) // the added '\n' is none of the file's
                end_ = linesEnd_;
            fileOffset_ += fileEnds ? 1 : 0;
            return true;
        }
        if (size > longestLine)
            return Error{ErrorCode::corrupt, cat("the line is longer than ", longestLine, " bytes"), place(),
                         "is this a text file?"};
        rest = std::move(block_);
    }
}

std::string TextLines::place() const {
    return cat(source_.name(), ", line ", line_);
}

} // namespace stipple
