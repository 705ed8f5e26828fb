// A layered chunk of LAZ: a byte that chooses format, version and extra bytes, two bytes of point count, the
// chunk.
#include "shared/las/laz/layered_chunk.hpp"

#include <algorithm>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    using namespace stipple::las::laz;
    ByteReader from(ByteSpan(data, size));
    const unsigned kind = from.read<std::uint8_t>();
    const std::size_t points = from.read<std::uint16_t>() % 5000 + 1u;
    ByteSpan chunk = from.readBytes(from.remaining());

    const auto version = static_cast<std::uint16_t>(3 + (kind & 1));
    const unsigned format = 6 + (kind >> 1) % 5, extraBytes = kind / 10 % 5;
    Items items = {{ItemType::point14, 30, version}};
    if (format == 7)
        items.push_back({ItemType::rgb14, 6, version});
    if (format == 8 || format == 10)
        items.push_back({ItemType::rgbNir14, 8, version});
    if (format >= 9)
        items.push_back({ItemType::wavePacket14, 29, version});
    if (extraBytes != 0)
        items.push_back({ItemType::byte14, static_cast<std::uint16_t>(extraBytes), version});
    std::size_t recordLength = 0;
    for (const Item& item : items)
        recordLength += item.sizeBytes;

    Bytes padded(chunk.size() + decodePadding(recordLength), 0x5A), records(points * recordLength);
    std::copy(chunk.begin(), chunk.end(), padded.begin());
    auto decoder = makeLayeredDecoder(items, {});
    if (!decoder.ok())
        std::abort();
    if (!(*decoder)->start({padded.data(), chunk.size()}, points).ok() || !(*decoder)->decode(records).ok())
        return 0;

    // What was decoded can be encoded, and comes back.
    auto encoder = makeLayeredEncoder(items);
    (*encoder)->start();
    (*encoder)->encode(records);
    ByteSpan again = (*encoder)->finish();
    padded.assign(again.size() + decodePadding(recordLength), 0xA5);
    std::copy(again.begin(), again.end(), padded.begin());
    Bytes returned(records.size());
    if (!(*decoder)->start({padded.data(), again.size()}, points).ok() ||
        !(*decoder)->decode(returned).ok() || returned != records)
        std::abort();
    return 0;
}
