#include "shared/codec/integer_planes.hpp"

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
    ByteWriter plain, differences;
    plain.write<std::uint8_t>(0);
    writeEach(plain, values);
    std::vector<T> mapped(values.size());
    for (std::size_t i = 0; i < values.size(); ++i)
        mapped[i] = zigzagDifference(values[i], i > 0 ? values[i - 1] : T{0});
    differences.write<std::uint8_t>(1);
    writeEach<T>(differences, mapped);
    to.writeBytes(differences.size() < plain.size() ? differences.bytes() : plain.bytes());
}

template <class T>
Status readPlanes(ByteReader& from, std::span<T> values) {
    auto mode = from.read<std::uint8_t>();
    if (!from.ok() || mode > 1)
        return Error{ErrorCode::corrupt, "unknown way to store planes", {}, {}};
    Bytes plane(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        STIPPLE_CHECK(readFullSection(from, plane));
        for (std::size_t i = 0; i < plane.size(); ++i)
            values[i] = static_cast<T>(byte == 0 ? T{plane[i]}
                                                 : values[i] | static_cast<T>(T{plane[i]} << (8 * byte)));
    }
    if (mode == 1) {
        T before = 0;
        for (T& value : values)
            before = value =
                static_cast<T>(before + static_cast<T>((value >> 1) ^ static_cast<T>(T{0} - (value & 1))));
    }
    return {};
}

template void writePlanes<std::uint8_t>(ByteWriter&, std::span<const std::uint8_t>);
template void writePlanes<std::uint16_t>(ByteWriter&, std::span<const std::uint16_t>);
template void writePlanes<std::uint32_t>(ByteWriter&, std::span<const std::uint32_t>);
template void writePlanes<std::uint64_t>(ByteWriter&, std::span<const std::uint64_t>);
template Status readPlanes<std::uint8_t>(ByteReader&, std::span<std::uint8_t>);
template Status readPlanes<std::uint16_t>(ByteReader&, std::span<std::uint16_t>);
template Status readPlanes<std::uint32_t>(ByteReader&, std::span<std::uint32_t>);
template Status readPlanes<std::uint64_t>(ByteReader&, std::span<std::uint64_t>);

} // namespace stipple
