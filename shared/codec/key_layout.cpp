#include "shared/codec/key_layout.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/bit_stream.hpp"
#include "shared/codec/varint.hpp"

#include <algorithm>
#include <numeric>

namespace stipple {

void KeyLayout::complete() {
    keyBitsOf = {};
    keyBits = 0;
    std::array<int, 3> left{};
    for (std::size_t a = 0; a < 3; ++a)
        left[a] = bitLength(extent[a]);
    // From the highest level down; bits are collected most significant first and turned round below.
    for (int level = 32 + maxLift; level >= 0; --level)
        for (std::size_t a : {2u, 1u, 0u})
            if (keyBits < maxKeyBits && left[a] > 0 && left[a] - 1 + lift[a] == level) {
                axisOfBit[static_cast<std::size_t>(keyBits++)] = static_cast<std::uint8_t>(a);
                ++keyBitsOf[a];
                --left[a];
            }
    std::reverse(axisOfBit.begin(), axisOfBit.begin() + keyBits);
    lowBits = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        lowBitsOf[a] = static_cast<std::uint8_t>(left[a]);
        lowBits += left[a];
    }
}

KeyLayout fitLayout(std::span<const Vec3<std::uint32_t>> points) {
    KeyLayout layout;
    if (points.empty())
        return layout;
    for (int axis = 0; axis < 3; ++axis) {
        std::uint32_t low = points[0][axis], high = low;
        for (const auto& point : points) {
            low = std::min(low, point[axis]);
            high = std::max(high, point[axis]);
        }
        std::uint32_t step = 0;
        for (const auto& point : points) {
            step = std::gcd(step, point[axis] - low);
            if (step == 1)
                break;
        }
        auto a = static_cast<std::size_t>(axis);
        layout.origin[a] = low;
        layout.step[a] = std::max(step, 1u);
        layout.extent[a] = (high - low) / layout.step[a];
    }
    layout.complete();
    return layout;
}

void writeLayout(ByteWriter& to, const KeyLayout& layout) {
    for (std::size_t a = 0; a < 3; ++a) {
        writeVarint(to, layout.origin[a]);
        writeVarint(to, layout.step[a]);
        writeVarint(to, layout.extent[a]);
        to.write(layout.lift[a]);
    }
}

Result<KeyLayout> readLayout(ByteReader& from, int nodeBits) {
    KeyLayout layout;
    std::uint64_t limit = std::uint64_t{1} << nodeBits;
    for (std::size_t a = 0; a < 3; ++a) {
        std::uint64_t origin = readVarint(from), step = readVarint(from), extent = readVarint(from);
        layout.lift[a] = from.read<std::uint8_t>();
        if (!from.ok())
            return Error{ErrorCode::truncated, say("the key layout ends early"), {}, {}};
        if (origin >= limit || step == 0 || step > limit || extent >= limit ||
            extent > (limit - 1 - origin) / step || layout.lift[a] > maxLift)
            return Error{ErrorCode::corrupt, say("the key layout of axis ", a, " leaves the node"), {}, {}};
        layout.origin[a] = static_cast<std::uint32_t>(origin);
        layout.step[a] = static_cast<std::uint32_t>(step);
        layout.extent[a] = static_cast<std::uint32_t>(extent);
    }
    layout.complete();
    return layout;
}

BitPermutation::BitPermutation(std::span<const int> target) {
    for (std::size_t byte = 0; byte < 8; ++byte) {
        auto& table = tables_[byte];
        table[0] = 0;
        for (std::size_t bit = 0; bit < 8; ++bit) {
            std::size_t from = 8 * byte + bit;
            int to = from < target.size() ? target[from] : -1;
            std::uint64_t moved = to < 0 ? 0 : std::uint64_t{1} << to;
            for (std::size_t i = 0; i < (std::size_t{1} << bit); ++i)
                table[(std::size_t{1} << bit) + i] = table[i] | moved;
        }
    }
}

namespace {
// Where key bit j stands in the packed coordinates.
std::array<int, maxKeyBits> packedBitOfKeyBit(const KeyLayout& layout) {
    std::array<int, 3> next{0, layout.keyBitsOf[0], layout.keyBitsOf[0] + layout.keyBitsOf[1]};
    std::array<int, maxKeyBits> place{};
    for (std::size_t j = 0; j < static_cast<std::size_t>(layout.keyBits); ++j)
        place[j] = next[layout.axisOfBit[j]]++;
    return place;
}
} // namespace

BitPermutation keyFromPacked(const KeyLayout& layout) {
    auto place = packedBitOfKeyBit(layout);
    std::array<int, maxKeyBits> target{};
    for (std::size_t j = 0; j < static_cast<std::size_t>(layout.keyBits); ++j)
        target[static_cast<std::size_t>(place[j])] = static_cast<int>(j);
    return BitPermutation(std::span(target).first(static_cast<std::size_t>(layout.keyBits)));
}

BitPermutation packedFromKey(const KeyLayout& layout) {
    auto place = packedBitOfKeyBit(layout);
    return BitPermutation(std::span<const int>(place).first(static_cast<std::size_t>(layout.keyBits)));
}

} // namespace stipple
