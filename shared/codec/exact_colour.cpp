#include "shared/codec/exact_colour.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/colour_planes.hpp"

#include <vector>

namespace stipple {

namespace {

enum class Coding : std::uint8_t { residual = 0, plain = 1 };

// One channel, of 16 bits or of a byte.
template <class T>
std::vector<T> channelOf(std::span<const std::uint16_t> values, std::size_t channels, std::size_t channel,
                         int shift) {
    std::vector<T> part(values.size() / channels);
    for (std::size_t i = 0; i < part.size(); ++i)
        part[i] = static_cast<T>(values[i * channels + channel] >> shift);
    return part;
}

template <class T>
void subtract(std::vector<T>& from, const std::vector<T>& what) {
    for (std::size_t i = 0; i < from.size(); ++i)
        from[i] = static_cast<T>(from[i] - what[i]);
}

template <class T>
void encodeAs(ByteWriter& to, std::span<const std::uint16_t> exact, std::span<const std::uint16_t> shown,
              std::size_t channels, int shift) {
    ByteWriter best;
    best.write(Coding::residual);
    std::vector<T> green;
    for (std::size_t c = 0; c < channels; ++c) {
        std::size_t channel = channels == 1 ? 0 : channelOrder[c];
        std::vector<T> own = channelOf<T>(exact, channels, channel, shift);
        subtract(own, channelOf<T>(shown, channels, channel, shift));
        if (c == 0)
            green = own;
        else
            subtract(own, green);
        writePlane<T>(best, own);
    }
    if (2 * best.size() > exact.size()) { // over four bits a value: the colours themselves may be simpler
        ByteWriter plain;
        plain.write(Coding::plain);
        for (std::size_t c = 0; c < channels; ++c)
            writePlane<T>(plain, channelOf<T>(exact, channels, channels == 1 ? 0 : channelOrder[c], shift));
        if (plain.size() < best.size())
            best = std::move(plain);
    }
    to.writeBytes(best.bytes());
}

template <class T>
Status readPlane(ByteReader& from, std::vector<T>& values, const WorkGate* gate) {
    Bytes part(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        STIPPLE_CHECK(readFullSection(from, part));
        STIPPLE_CHECK(inPieces(gate, part.size(), [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i)
                values[i] = static_cast<T>(values[i] | part[i] << (8 * byte));
        }));
    }
    return {};
}

template <class T>
Status decodeAs(ByteReader& from, std::span<const std::uint32_t> order, std::size_t channels,
                ColourWidth width, std::span<std::uint16_t> colours, const WorkGate* gate) {
    auto coding = from.read<Coding>();
    if (!from.ok() || coding > Coding::plain)
        return Error{ErrorCode::corrupt, say("unknown way to store exact colours"), {}, {}};
    const std::uint32_t unit = unitOf(width);
    const int shift = shiftOf(width);
    std::vector<T> green;
    for (std::size_t c = 0; c < channels; ++c) {
        std::size_t channel = channels == 1 ? 0 : channelOrder[c];
        std::vector<T> own(order.size());
        STIPPLE_CHECK(readPlane(from, own, gate));
        const std::size_t points = (colours.size() + channels - 1) / channels;
        STIPPLE_CHECK(inPieces(gate, points, [&](std::size_t first, std::size_t end) {
            for (std::size_t i = first; i < end; ++i) {
                std::uint16_t& value = colours[i * channels + channel];
                T part = own[order[i]];
                if (coding == Coding::residual)
                    part = static_cast<T>(part + (value >> shift) + (c > 0 ? green[order[i]] : T{}));
                value = static_cast<std::uint16_t>(part * unit);
            }
        }));
        if (c == 0)
            green = std::move(own);
    }
    return {};
}

} // namespace

// [u8 width] [u8 coding] [per channel: section of the low bytes, and one of the high bytes if wide]
void writeExactColour(ByteWriter& to, std::span<const std::uint16_t> exact,
                      std::span<const std::uint16_t> shown, int channels, ColourWidth width) {
    to.write(width);
    auto count = static_cast<std::size_t>(channels);
    if (width == ColourWidth::wide)
        encodeAs<std::uint16_t>(to, exact, shown, count, 0);
    else
        encodeAs<std::uint8_t>(to, exact, shown, count, shiftOf(width));
}

Status readExactColour(ByteReader& from, std::span<const std::uint32_t> order, int channels,
                       std::span<std::uint16_t> colours, const WorkGate* gate) {
    auto width = from.read<ColourWidth>();
    if (!from.ok() || width > ColourWidth::repeated)
        return Error{ErrorCode::corrupt, say("unknown colour width ", static_cast<int>(width)), {}, {}};
    auto count = static_cast<std::size_t>(channels);
    return width == ColourWidth::wide ? decodeAs<std::uint16_t>(from, order, count, width, colours, gate)
                                      : decodeAs<std::uint8_t>(from, order, count, width, colours, gate);
}

} // namespace stipple
