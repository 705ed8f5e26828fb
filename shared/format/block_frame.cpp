#include "shared/format/block_frame.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"

#include <algorithm>

namespace stipple {

Bytes frameBlock(ByteSpan payload) {
    ByteWriter block;
    block.write(static_cast<std::uint32_t>(payload.size()));
    block.write(blockChecksum(payload));
    block.writeBytes(payload);
    return block.take();
}

Bytes framePaddedBlock(ByteSpan payload) {
    Bytes block = frameBlock(payload);
    if (block.size() >= paddedFrom)
        block.resize((block.size() + paddedTo - 1) / paddedTo * paddedTo);
    return block;
}

Result<ByteSpan> unframeBlock(ByteSpan block, const std::string& name, std::uint64_t offsetBytes) {
    std::string where = cat(name, ", byte ", offsetBytes);
    ByteReader reader(block);
    auto size = reader.read<std::uint32_t>();
    auto checksum = reader.read<std::uint32_t>();
    if (!reader.ok())
        return Error{
            ErrorCode::truncated, say("the block's frame ends after ", block.size(), " bytes"), where, {}};
    if (size > reader.remaining())
        return Error{ErrorCode::truncated,
                     say("the block says that it holds ", size, " bytes, but there are ", reader.remaining()),
                     where,
                     {}};
    ByteSpan payload = reader.readBytes(size);
    if (blockChecksum(payload) != checksum)
        return Error{ErrorCode::corrupt, say("the block's checksum does not match its bytes"), where,
                     say("the file was altered or damaged; copy or convert it again")};
    ByteSpan padding = reader.readBytes(reader.remaining());
    if (padding.size() >= paddedTo ||
        std::any_of(padding.begin(), padding.end(), [](auto byte) { return byte != 0; }))
        return Error{ErrorCode::corrupt, say("there are bytes behind the block's payload"), where, {}};
    return payload;
}

} // namespace stipple
