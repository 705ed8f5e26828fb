#include "client/region/piece_sink.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

Status PieceSink::overwrite(std::uint64_t offset, ByteSpan bytes) {
    std::uint64_t size = to_->offset + to_->fresh.size();
    if (bytes.size() > size || offset > size - bytes.size())
        return Error{ErrorCode::invalidArgument, say("bytes from ", offset, " on are not there to overwrite"),
                     "", ""};
    if (offset < to_->offset) {
        std::uint64_t taken = std::min<std::uint64_t>(bytes.size(), to_->offset - offset);
        ByteSpan part = bytes.subspan(0, static_cast<std::size_t>(taken));
        to_->patches.emplace_back(offset, Bytes(part.begin(), part.end()));
        bytes = bytes.subspan(static_cast<std::size_t>(taken));
        offset += taken;
    }
    if (!bytes.empty())
        std::copy(bytes.begin(), bytes.end(),
                  to_->fresh.begin() + static_cast<std::ptrdiff_t>(offset - to_->offset));
    return {};
}

} // namespace stipple
