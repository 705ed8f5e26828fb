#include "shared/codec/progressive_order.hpp"

#include "shared/codec/bit_stream.hpp"

namespace stipple {

std::vector<std::uint32_t> bitReversedOrder(std::uint32_t count) {
    if (count <= 1)
        return std::vector<std::uint32_t>(count, 0);
    int bits = bitLength(count - 1);
    // reverse(2^k + i) = reverse(i) + 2^(bits-1-k): each round doubles the table.
    std::vector<std::uint32_t> order(std::size_t{1} << bits);
    for (int k = 0; k < bits; ++k) {
        std::size_t known = std::size_t{1} << k;
        std::uint32_t top = 1u << (bits - 1 - k);
        for (std::size_t i = 0; i < known; ++i)
            order[known + i] = order[i] | top;
    }
    std::size_t kept = 0;
    for (std::uint32_t j : order) {
        order[kept] = j;
        kept += j < count;
    }
    order.resize(count);
    return order;
}

std::vector<std::uint32_t> progressiveOrder(std::uint32_t pointCount) {
    std::vector<std::uint32_t> order;
    order.reserve(pointCount);
    for (int stratum = 0; stratum < strataCount; ++stratum)
        for (std::uint32_t j : bitReversedOrder(stratumPoints(pointCount, stratum)))
            order.push_back(stratumFirst(stratum) + j * stratumStep(stratum));
    return order;
}

} // namespace stipple
