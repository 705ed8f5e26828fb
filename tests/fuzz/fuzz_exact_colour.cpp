// A block of exact colours: one byte for the channels, two for the points, then its bytes.
#include "shared/codec/exact_colour.hpp"
#include "shared/codec/progressive_order.hpp"

#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    ByteReader from(ByteSpan(data, size));
    int channels = from.read<std::uint8_t>() % 2 == 0 ? 3 : 1;
    std::uint32_t points = from.read<std::uint16_t>() % 4096;
    if (!from.ok())
        return 0;
    std::vector<std::uint16_t> colours(points * static_cast<std::size_t>(channels), 0x1234);
    (void)readExactColour(from, progressiveOrder(points), channels, colours);
    return 0;
}
