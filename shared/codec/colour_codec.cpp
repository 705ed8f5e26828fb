#include "shared/codec/colour_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/colour_planes.hpp"
#include "shared/codec/progressive_order.hpp"

#include <algorithm>

namespace stipple {

namespace {

enum class Coding : std::uint8_t { predicted = 0, plain = 1 };

// Predictions for the points of a stratum > 0 from the values of the earlier ones, `known`.
template <class T>
void predictBetween(std::span<const T> known, NeighbourChoices choices, std::span<T> to) {
    auto predicted = [&](std::size_t j, T a, T b) {
        T first = choices[j] == NeighbourChoice::upper ? b : a;
        T second = choices[j] == NeighbourChoice::lower ? a : b;
        return static_cast<T>((std::uint32_t{first} + second + 1) / 2);
    };
    std::size_t pairs = std::min(to.size(), known.size() - 1);
    for (std::size_t j = 0; j < pairs; ++j)
        to[j] = predicted(j, known[j], known[j + 1]);
    if (pairs < to.size()) // the last point may have no upper neighbour
        to[pairs] = known[pairs];
}

// The stratum's values of one channel, and the earlier strata's, in Morton order.
template <class T>
std::vector<T> every(std::span<const std::uint16_t> values, std::size_t channels, std::size_t channel,
                     std::size_t first, std::size_t step, int shift) {
    const std::size_t count = values.size() / channels;
    std::vector<T> part(first < count ? (count - first - 1) / step + 1 : 0);
    const std::uint16_t* from = values.data() + first * channels + channel;
    for (std::size_t j = 0; j < part.size(); ++j)
        part[j] = static_cast<T>(from[j * step * channels] >> shift);
    return part;
}

template <class T>
std::vector<T> residuals(std::span<const std::uint16_t> values, std::size_t channels, std::size_t channel,
                         int shift, int stratum, NeighbourChoices choices) {
    std::size_t first = stratumFirst(stratum), step = stratumStep(stratum);
    std::vector<T> own = every<T>(values, channels, channel, first, step, shift);
    if (stratum == 0) {
        T before = 0;
        for (T& value : own)
            value = static_cast<T>(value - std::exchange(before, value));
        return own;
    }
    std::vector<T> known = every<T>(values, channels, channel, 0, 2 * first, shift), predicted(own.size());
    predictBetween<T>(known, choices, predicted);
    for (std::size_t j = 0; j < own.size(); ++j)
        own[j] = static_cast<T>(own[j] - predicted[j]);
    return own;
}

template <class T>
void encodeAs(ByteWriter& to, std::span<const std::uint16_t> values, std::size_t channels, int shift,
              int stratum, NeighbourChoices choices) {
    ByteWriter predicted;
    predicted.write(Coding::predicted);
    std::vector<T> green;
    for (std::size_t c = 0; c < channels; ++c) {
        std::size_t channel = channels == 1 ? 0 : channelOrder[c];
        std::vector<T> residual = residuals<T>(values, channels, channel, shift, stratum, choices);
        if (c == 0)
            green = residual;
        else
            for (std::size_t j = 0; j < residual.size(); ++j)
                residual[j] = static_cast<T>(residual[j] - green[j]);
        writePlane<T>(predicted, residual);
    }
    ByteWriter plain;
    if (channels == 1) { // intensities are often noise, which differences only widen
        plain.write(Coding::plain);
        writePlane<T>(plain, every<T>(values, 1, 0, stratumFirst(stratum), stratumStep(stratum), shift));
    }
    to.writeBytes(channels == 1 && plain.size() < predicted.size() ? plain.bytes() : predicted.bytes());
}

// Three colours, or one intensity, side by side in a word: arithmetic on all of them at once, each modulo the
// width of its lane.
template <class Word>
struct Lanes {
    static constexpr int bits = sizeof(Word) == 4 ? 8 : 16;
    static constexpr Word one =
        sizeof(Word) == 4 ? static_cast<Word>(0x010101u) : static_cast<Word>(0x000100010001ull);
    static constexpr Word top = static_cast<Word>(one << (bits - 1));
    static constexpr Word mask = static_cast<Word>((Word{1} << bits) - 1);

    static Word add(Word a, Word b) { return ((a & ~top) + (b & ~top)) ^ ((a ^ b) & top); }
    // (a + b + 1) / 2
    static Word mean(Word a, Word b) { return (a | b) - (((a ^ b) & ~one) >> 1); }
};

// The residuals of every channel; lanes that a channel count leaves free are zero.
template <class Word>
Status readResiduals(ByteReader& from, std::size_t channels, const WorkGate* gate, std::vector<Word>& to) {
    constexpr int bits = Lanes<Word>::bits;
    Bytes plane(to.size());
    for (std::size_t c = 0; c < channels; ++c)
        for (int byte = 0; byte < bits; byte += 8) {
            STIPPLE_CHECK(readFullSection(from, plane));
            int shift = byte + bits * static_cast<int>(channels == 1 ? 0 : channelOrder[c]);
            STIPPLE_CHECK(inPieces(gate, to.size(), [&](std::size_t first, std::size_t end) {
                for (std::size_t j = first; j < end; ++j)
                    to[j] |= Word{plane[j]} << shift;
            }));
        }
    return {};
}

// Puts the new points between the known ones.
template <class Word>
Status merge(std::vector<Word>& known, std::span<const Word> fresh, const WorkGate* gate) {
    std::vector<Word> merged(known.size() + fresh.size());
    STIPPLE_CHECK(inPieces(gate, fresh.size(), [&](std::size_t first, std::size_t end) {
        for (std::size_t j = first; j < end; ++j) {
            merged[2 * j] = known[j];
            merged[2 * j + 1] = fresh[j];
        }
    }));
    if (known.size() > fresh.size())
        merged.back() = known.back();
    known.swap(merged);
    return {};
}

} // namespace

ColourWidth narrowestWidth(std::span<const std::uint16_t> values) {
    bool low = true, high = true, repeated = true;
    for (std::uint16_t value : values) {
        low = low && value < 256;
        high = high && value % 256 == 0;
        repeated = repeated && value % 257 == 0;
    }
    return low        ? ColourWidth::low
           : high     ? ColourWidth::high
           : repeated ? ColourWidth::repeated
                      : ColourWidth::wide;
}

void roundTo(ColourWidth width, std::span<std::uint16_t> values) {
    auto round = [&]<std::uint32_t unit>(std::integral_constant<std::uint32_t, unit>) {
        for (std::uint16_t& value : values)
            value =
                static_cast<std::uint16_t>(std::min<std::uint32_t>((value + unit / 2) / unit, 255) * unit);
    };
    if (width == ColourWidth::low)
        round(std::integral_constant<std::uint32_t, 1>{});
    else if (width == ColourWidth::high)
        round(std::integral_constant<std::uint32_t, 256>{});
    else if (width == ColourWidth::repeated)
        round(std::integral_constant<std::uint32_t, 257>{});
}

// [u8 width, in stratum 0] [u8 coding] [per channel: section of the residuals' low bytes, and one of their
// high bytes if wide]
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, int channels, ColourWidth width,
                  int stratum, NeighbourChoices choices) {
    if (stratum == 0)
        to.write(width);
    auto count = static_cast<std::size_t>(channels);
    if (width == ColourWidth::wide)
        encodeAs<std::uint16_t>(to, values, count, 0, stratum, choices);
    else
        encodeAs<std::uint8_t>(to, values, count, shiftOf(width), stratum, choices);
}

ColourDecoder::ColourDecoder(std::uint32_t pointCount, int channels, int strata, const WorkGate* gate)
    : gate_(gate), pointCount_(pointCount), channels_(static_cast<std::size_t>(channels)) {
    values_.reserve(strataPrefixPoints(pointCount, strata) * channels_);
}

Status ColourDecoder::decode(int stratum, ByteReader& from, NeighbourChoices choices) {
    if (stratum == 0) {
        auto width = from.read<std::uint8_t>();
        if (!from.ok() || width > static_cast<std::uint8_t>(ColourWidth::repeated))
            return Error{ErrorCode::corrupt, say("unknown colour width ", width), {}, {}};
        width_ = static_cast<ColourWidth>(width);
    }
    return width_ == ColourWidth::wide ? decodeAs(wide_, stratum, from, choices)
                                       : decodeAs(narrow_, stratum, from, choices);
}

template <class Word>
Status ColourDecoder::decodeAs(std::vector<Word>& known, int stratum, ByteReader& from,
                               NeighbourChoices choices) {
    auto coding = from.read<Coding>();
    if (!from.ok() || coding > Coding::plain || (coding == Coding::plain && channels_ != 1))
        return Error{ErrorCode::corrupt, say("unknown way to store colours"), {}, {}};
    std::vector<Word> fresh(stratumPoints(pointCount_, stratum));
    STIPPLE_CHECK(readResiduals(from, channels_, gate_, fresh));
    if (coding == Coding::predicted)
        STIPPLE_CHECK(predict(known, stratum, choices, fresh));
    STIPPLE_CHECK(append<Word>(fresh));
    if (stratum > 0)
        return merge<Word>(known, fresh, gate_);
    known = std::move(fresh);
    return {};
}

// From residuals to values.
template <class Word>
Status ColourDecoder::predict(const std::vector<Word>& known, int stratum, NeighbourChoices choices,
                              std::vector<Word>& fresh) const {
    using Lane = Lanes<Word>;
    if (channels_ == 3) {
        constexpr Word exceptGreen = static_cast<Word>(~(Lane::mask << Lane::bits));
        STIPPLE_CHECK(inPieces(gate_, fresh.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t j = begin; j < end; ++j) // green's residual is part of those of red and blue
                fresh[j] =
                    Lane::add(fresh[j], ((fresh[j] >> Lane::bits) & Lane::mask) * (Lane::one & exceptGreen));
        }));
    }
    if (stratum == 0) {
        Word last = 0;
        return inPieces(gate_, fresh.size(), [&](std::size_t begin, std::size_t end) {
            Word before = last;
            for (std::size_t j = begin; j < end; ++j)
                before = fresh[j] = Lane::add(fresh[j], before);
            last = before;
        });
    }
    std::size_t pairs = std::min(fresh.size(), known.size() - 1);
    STIPPLE_CHECK(inPieces(gate_, pairs, [&](std::size_t begin, std::size_t end) {
        for (std::size_t j = begin; j < end; ++j) {
            Word a = known[j], b = known[j + 1];
            Word first = choices[j] == NeighbourChoice::upper ? b : a;
            Word second = choices[j] == NeighbourChoice::lower ? a : b;
            fresh[j] = Lane::add(fresh[j], Lane::mean(first, second));
        }
    }));
    if (pairs < fresh.size()) // the last point may have no upper neighbour
        fresh[pairs] = Lane::add(fresh[pairs], known[pairs]);
    return {};
}

// Appends a stratum's values in progressive order.
template <class Word>
Status ColourDecoder::append(std::span<const Word> fresh) {
    using Lane = Lanes<Word>;
    Word unit = unitOf(width_);
    std::size_t start = values_.size();
    values_.resize(start + fresh.size() * channels_);
    std::uint16_t* values = values_.data() + start;
    STIPPLE_TRY(order, bitReversedOrder(static_cast<std::uint32_t>(fresh.size()), gate_));
    const std::uint32_t* places = order.data();
    if (channels_ == 1)
        return inPieces(gate_, fresh.size(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i)
                values[i] = static_cast<std::uint16_t>(fresh[places[i]] * unit);
        });
    return inPieces(gate_, fresh.size(), [&](std::size_t begin, std::size_t end) {
        std::uint16_t* to = values + 3 * begin;
        for (std::size_t i = begin; i < end; ++i, to += 3) {
            Word word = fresh[places[i]];
            to[0] = static_cast<std::uint16_t>((word & Lane::mask) * unit);
            to[1] = static_cast<std::uint16_t>(((word >> Lane::bits) & Lane::mask) * unit);
            to[2] = static_cast<std::uint16_t>((word >> (2 * Lane::bits)) * unit);
        }
    });
}

} // namespace stipple
