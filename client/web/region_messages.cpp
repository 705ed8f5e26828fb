#include "client/web/region_messages.hpp"

#include "client/web/entry_message.hpp"

namespace stipple::web {

namespace {
constexpr std::uint32_t regionMark = 0x314E5253; // "SRN1"
}

Bytes encodeRegionNode(const RegionNode& node) {
    ByteWriter out;
    out.write(regionMark);
    writeEntry(out, node.node.entry);
    out.write(static_cast<std::uint8_t>(node.tested));
    return out.take();
}

Result<RegionNode> decodeRegionNode(ByteSpan message) {
    ByteReader in(message);
    RegionNode node;
    bool isOne = in.read<std::uint32_t>() == regionMark && readEntry(in, node.node.entry);
    node.tested = in.read<std::uint8_t>() != 0;
    if (!isOne || !in.ok() || in.remaining() != 0)
        return Error{ErrorCode::corrupt, say("a message is no node of a region"), "region worker",
                     say("reload the page")};
    return node;
}

} // namespace stipple::web
