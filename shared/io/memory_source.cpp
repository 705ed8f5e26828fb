#include "shared/io/memory_source.hpp"

#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple {

ByteSource::RequestId MemorySource::read(ByteRange range, Completion done) {
    RequestId id = ++next_;
    if (range.offset > bytes_.size() || (range.offset == bytes_.size() && range.size > 0)) {
        done(Error{ErrorCode::truncated,
                   say("byte ", range.offset, " was asked for, but there are only ", bytes_.size()), name_,
                   ""});
        return id;
    }
    std::uint64_t size = std::min<std::uint64_t>(range.size, bytes_.size() - range.offset);
    auto first = bytes_.begin() + static_cast<std::ptrdiff_t>(range.offset);
    done(Bytes(first, first + static_cast<std::ptrdiff_t>(size)));
    return id;
}

} // namespace stipple
