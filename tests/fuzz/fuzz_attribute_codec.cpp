// A column: one byte that chooses its width, one for its components, two for the points, then its bytes.
#include "shared/codec/column_codec.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace stipple;
    ByteReader from(ByteSpan(data, size));
    std::size_t width = std::size_t{1} << (from.read<std::uint8_t>() % 4);
    std::size_t components = from.read<std::uint8_t>() % 4 + 1u;
    std::size_t points = from.read<std::uint16_t>() % 4096;
    if (!from.ok())
        return 0;
    auto values = decodeColumn(from, points, width, components);
    if (values.ok() && values->size() != points * width * components)
        std::abort();
    return 0;
}
