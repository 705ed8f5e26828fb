// Positions and colours of one node: two bytes of point count, one of node bits, then stratum after stratum.
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    ByteReader from(ByteSpan(data, size));
    std::uint32_t count = from.read<std::uint16_t>() % 4096 + 1u;
    auto head = from.read<std::uint8_t>();
    int nodeBits = head % 32, strata = 1 + head / 32 % 4;
    int channels = head >= 128 ? 3 : 1;
    if (!from.ok())
        return 0;
    PositionDecoder positions(count, nodeBits, strata);
    ColourDecoder colours(count, channels, strata);
    for (int s = 0; s < strata; ++s) {
        if (stratumPoints(count, s) == 0)
            continue;
        if (!positions.decode(s, from).ok() || !colours.decode(s, from, positions.choices()).ok())
            return 0;
    }
    auto points = positions.takePositions();
    if (!points.ok())
        return 0;
    for (const auto& p : *points)
        if ((std::uint64_t{p.x} | p.y | p.z) >> nodeBits != 0)
            std::abort(); // a point outside its node
    if (colours.takeValues().size() != points->size() * static_cast<std::size_t>(channels))
        std::abort();
    return 0;
}
