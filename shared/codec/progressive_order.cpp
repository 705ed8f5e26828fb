#include "shared/codec/progressive_order.hpp"

#include "shared/codec/bit_stream.hpp"

namespace stipple {

std::vector<std::uint32_t> bitReversedOrder(std::uint32_t count) {
    return *bitReversedOrder(count, nullptr);
}

std::vector<std::uint32_t> progressiveOrder(std::uint32_t pointCount) {
    return *progressiveOrder(pointCount, nullptr);
}

Result<std::vector<std::uint32_t>> bitReversedOrder(std::uint32_t count, const WorkGate* gate) {
    if (count <= 1)
        return std::vector<std::uint32_t>(count, 0);
    int bits = bitLength(count - 1);
    // reverse(2^k + i) = reverse(i) + 2^(bits-1-k): each round doubles the table.
    std::vector<std::uint32_t> order(std::size_t{1} << bits);
    for (int k = 0; k < bits; ++k) {
        std::size_t known = std::size_t{1} << k;
        std::uint32_t top = 1u << (bits - 1 - k);
        STIPPLE_CHECK(inPieces(gate, known, [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                order[known + i] = order[i] | top;
        }));
    }
    std::size_t kept = 0;
    STIPPLE_CHECK(inPieces(gate, order.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t i = first; i < end; ++i) {
            std::uint32_t j = order[i];
            order[kept] = j;
            kept += j < count;
        }
    }));
    order.resize(count);
    return order;
}

Result<std::vector<std::uint32_t>> progressiveOrder(std::uint32_t pointCount, const WorkGate* gate) {
    std::vector<std::uint32_t> order;
    order.reserve(pointCount);
    for (int stratum = 0; stratum < strataCount; ++stratum) {
        STIPPLE_TRY(inside, bitReversedOrder(stratumPoints(pointCount, stratum), gate));
        STIPPLE_CHECK(inPieces(gate, inside.size(), [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                order.push_back(stratumFirst(stratum) + inside[i] * stratumStep(stratum));
        }));
    }
    return order;
}

} // namespace stipple
