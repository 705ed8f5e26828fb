#include "shared/codec/integer_planes.hpp"

#include "shared/codec/bit_stream.hpp"

#include <algorithm>
#include <array>
#include <type_traits>
#include <vector>

namespace stipple {

namespace {

template <class T>
T zigzagDifference(T value, T before) {
    auto difference = static_cast<std::make_signed_t<T>>(static_cast<T>(value - before));
    constexpr int signShift = 8 * sizeof(T) - 1;
    return static_cast<T>(static_cast<T>(difference << 1) ^ static_cast<T>(difference >> signShift));
}

// log2 of 1 + i/256 in 1/65536, by repeated squaring: integers only, as a choice made by it must not depend
// on how a machine computes a logarithm.
constexpr auto fractionLogs = [] {
    std::array<std::uint32_t, 256> logs{};
    for (std::uint32_t i = 0; i < logs.size(); ++i) {
        std::uint64_t x = std::uint64_t{256 + i} << 22; // 1 + i/256, with 30 bits after the point
        for (int bit = 15; bit >= 0; --bit) {
            x = x * x >> 30;
            if (x >> 31 != 0) {
                logs[i] |= 1u << bit;
                x >>= 1;
            }
        }
    }
    return logs;
}();

// About 65536 × log2(value), value > 0.
std::uint64_t scaledLog2(std::uint32_t value) {
    int length = bitLength(value) - 1;
    std::uint32_t fraction = length >= 8 ? value >> (length - 8) : value << (8 - length);
    return (static_cast<std::uint64_t>(length) << 16) + fractionLogs[fraction & 0xFF];
}

// What the planes' bytes take when each is coded by its frequency in its plane, and in a bit at least, in
// 1/65536 bits: what Huffman codes come close to.
template <class T>
std::uint64_t planesCost(std::span<const T> values) {
    constexpr std::uint64_t oneBit = 1 << 16;
    std::uint64_t cost = 0;
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        std::array<std::uint32_t, 256> counts{};
        for (T value : values)
            ++counts[static_cast<std::uint8_t>(value >> (8 * byte))];
        std::uint64_t all = scaledLog2(static_cast<std::uint32_t>(values.size()));
        for (std::uint32_t count : counts)
            if (count > 0 && count < values.size())
                cost += count * std::max(oneBit, all - std::min(all, scaledLog2(count)));
    }
    return cost;
}

template <class T>
void writeEach(ByteWriter& to, std::span<const T> values) {
    Bytes plane(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        for (std::size_t i = 0; i < plane.size(); ++i)
            plane[i] = static_cast<std::uint8_t>(values[i] >> (8 * byte));
        writeSection(to, plane, Effort::literals);
    }
}

} // namespace

template <class T>
void writePlanes(ByteWriter& to, std::span<const T> values) {
    std::vector<T> differences(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        differences[i] = zigzagDifference(values[i], i > 0 ? values[i - 1] : T{0});
    std::uint64_t plainCost = planesCost<T>(values), differencesCost = planesCost<T>(differences);
    auto written = [](std::uint8_t mode, std::span<const T> planes) {
        ByteWriter bytes;
        bytes.write(mode);
        writeEach<T>(bytes, planes);
        return bytes;
    };
    // An estimate that is clear saves coding both.
    auto isClear = [](std::uint64_t less, std::uint64_t more) { return less + less / 16 < more; };
    ByteWriter best;
    if (isClear(plainCost, differencesCost)) {
        best = written(0, values);
    } else if (isClear(differencesCost, plainCost)) {
        best = written(1, differences);
    } else {
        best = written(0, values);
        if (ByteWriter other = written(1, differences); other.size() < best.size())
            best = std::move(other);
    }
    to.writeBytes(best.bytes());
}

template <class T>
Status readPlanes(ByteReader& from, std::span<T> values, const WorkGate* gate) {
    auto mode = from.read<std::uint8_t>();
    if (!from.ok() || mode > 1)
        return Error{ErrorCode::corrupt, say("unknown way to store planes"), {}, {}};
    Bytes plane(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        STIPPLE_CHECK(readFullSection(from, plane));
        STIPPLE_CHECK(inPieces(gate, plane.size(), [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                values[i] = static_cast<T>(byte == 0 ? T{plane[i]}
                                                     : values[i] | static_cast<T>(T{plane[i]} << (8 * byte)));
        }));
    }
    if (mode == 0)
        return {};
    T last = 0;
    return inPieces(gate, values.size(), [&](std::size_t first, std::size_t end) {
        T before = last;
        for (T& value : values.subspan(first, end - first))
            before = value =
                static_cast<T>(before + static_cast<T>((value >> 1) ^ static_cast<T>(T{0} - (value & 1))));
        last = before;
    });
}

template void writePlanes<std::uint8_t>(ByteWriter&, std::span<const std::uint8_t>);
template void writePlanes<std::uint16_t>(ByteWriter&, std::span<const std::uint16_t>);
template void writePlanes<std::uint32_t>(ByteWriter&, std::span<const std::uint32_t>);
template void writePlanes<std::uint64_t>(ByteWriter&, std::span<const std::uint64_t>);
template Status readPlanes<std::uint8_t>(ByteReader&, std::span<std::uint8_t>, const WorkGate*);
template Status readPlanes<std::uint16_t>(ByteReader&, std::span<std::uint16_t>, const WorkGate*);
template Status readPlanes<std::uint32_t>(ByteReader&, std::span<std::uint32_t>, const WorkGate*);
template Status readPlanes<std::uint64_t>(ByteReader&, std::span<std::uint64_t>, const WorkGate*);

} // namespace stipple
