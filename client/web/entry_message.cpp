#include "client/web/entry_message.hpp"

namespace stipple::web {

void writeKey(ByteWriter& out, const NodeKey& key) {
    out.write(key.level);
    out.write(key.x);
    out.write(key.y);
    out.write(key.z);
}

NodeKey readKey(ByteReader& in) {
    NodeKey key;
    key.level = in.read<std::uint8_t>();
    key.x = in.read<std::uint32_t>();
    key.y = in.read<std::uint32_t>();
    key.z = in.read<std::uint32_t>();
    return key;
}

void writeEntry(ByteWriter& out, const NodeEntry& entry) {
    writeKey(out, entry.key);
    out.write(entry.childMask);
    out.write(entry.pointCount);
    out.write(entry.offsetBytes);
    for (std::uint32_t size : entry.strataBytes)
        out.write(size);
    out.write(static_cast<std::uint32_t>(entry.attributeBytes.size()));
    for (std::uint32_t size : entry.attributeBytes)
        out.write(size);
}

bool readEntry(ByteReader& in, NodeEntry& entry) {
    entry.key = readKey(in);
    entry.childMask = in.read<std::uint8_t>();
    entry.pointCount = in.read<std::uint32_t>();
    entry.offsetBytes = in.read<std::uint64_t>();
    for (std::uint32_t& size : entry.strataBytes)
        size = in.read<std::uint32_t>();
    std::uint32_t blocks = in.read<std::uint32_t>();
    if (blocks > in.remaining() / sizeof(std::uint32_t))
        return false;
    entry.attributeBytes.resize(blocks);
    for (std::uint32_t& size : entry.attributeBytes)
        size = in.read<std::uint32_t>();
    return in.ok();
}

} // namespace stipple::web
