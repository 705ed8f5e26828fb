#include "shared/codec/colour_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/codec/section.hpp"

#include <algorithm>

namespace stipple {

namespace {

enum class Coding : std::uint8_t { predicted = 0, plain = 1 };

// Channels are coded green first; red and blue as what their residual differs from green's.
constexpr std::size_t channelOrder[3] = {1, 0, 2};

std::uint32_t unitOf(ColourWidth width) {
    return width == ColourWidth::high ? 256 : width == ColourWidth::repeated ? 257 : 1;
}

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

template <class T>
void writePlane(ByteWriter& to, std::span<const T> values) {
    Bytes part(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        for (std::size_t j = 0; j < part.size(); ++j)
            part[j] = static_cast<std::uint8_t>(values[j] >> (8 * byte));
        writeSection(to, part, Effort::literals);
    }
}

template <class T>
Status readPlane(ByteReader& from, std::span<T> values) {
    Bytes part(values.size());
    for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        STIPPLE_CHECK(readFullSection(from, part));
        for (std::size_t j = 0; j < part.size(); ++j)
            values[j] = static_cast<T>(byte == 0 ? part[j] : values[j] | part[j] << (8 * byte));
    }
    return {};
}

// The stratum's values of one channel, and the earlier strata's, in Morton order.
template <class T>
std::vector<T> every(std::span<const std::uint16_t> values, std::size_t channels, std::size_t channel,
                     std::size_t first, std::size_t step, std::uint32_t unit) {
    std::vector<T> part;
    part.reserve(values.size() / channels / step + 1);
    for (std::size_t i = first * channels + channel; i < values.size(); i += step * channels)
        part.push_back(static_cast<T>(values[i] / unit));
    return part;
}

template <class T>
std::vector<T> residuals(std::span<const std::uint16_t> values, std::size_t channels, std::size_t channel,
                         std::uint32_t unit, int stratum, NeighbourChoices choices) {
    std::size_t first = stratumFirst(stratum), step = stratumStep(stratum);
    std::vector<T> own = every<T>(values, channels, channel, first, step, unit);
    if (stratum == 0) {
        T before = 0;
        for (T& value : own)
            value = static_cast<T>(value - std::exchange(before, value));
        return own;
    }
    std::vector<T> known = every<T>(values, channels, channel, 0, 2 * first, unit), predicted(own.size());
    predictBetween<T>(known, choices, predicted);
    for (std::size_t j = 0; j < own.size(); ++j)
        own[j] = static_cast<T>(own[j] - predicted[j]);
    return own;
}

template <class T>
void encodeAs(ByteWriter& to, std::span<const std::uint16_t> values, std::size_t channels, std::uint32_t unit,
              int stratum, NeighbourChoices choices) {
    ByteWriter predicted;
    predicted.write(Coding::predicted);
    std::vector<T> green;
    for (std::size_t c = 0; c < channels; ++c) {
        std::size_t channel = channels == 1 ? 0 : channelOrder[c];
        std::vector<T> residual = residuals<T>(values, channels, channel, unit, stratum, choices);
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
        writePlane<T>(plain, every<T>(values, 1, 0, stratumFirst(stratum), stratumStep(stratum), unit));
    }
    to.writeBytes(channels == 1 && plain.size() < predicted.size() ? plain.bytes() : predicted.bytes());
}

// Puts the new points between the known ones.
template <class T>
void merge(std::vector<T>& known, std::span<const T> fresh) {
    std::vector<T> merged(known.size() + fresh.size());
    for (std::size_t j = 0; j < fresh.size(); ++j) {
        merged[2 * j] = known[j];
        merged[2 * j + 1] = fresh[j];
    }
    if (known.size() > fresh.size())
        merged.back() = known.back();
    known.swap(merged);
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

// [u8 width, in stratum 0] [u8 coding] [per channel: section of the residuals' low bytes, and one of their
// high bytes if wide]
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, int channels, ColourWidth width,
                  int stratum, NeighbourChoices choices) {
    if (stratum == 0)
        to.write(width);
    auto count = static_cast<std::size_t>(channels);
    if (width == ColourWidth::wide)
        encodeAs<std::uint16_t>(to, values, count, 1, stratum, choices);
    else
        encodeAs<std::uint8_t>(to, values, count, unitOf(width), stratum, choices);
}

ColourDecoder::ColourDecoder(std::uint32_t pointCount, int channels, int strata)
    : pointCount_(pointCount), channels_(static_cast<std::size_t>(channels)) {
    values_.reserve(strataPrefixPoints(pointCount, strata) * channels_);
}

Status ColourDecoder::decode(int stratum, ByteReader& from, NeighbourChoices choices) {
    if (stratum == 0) {
        auto width = from.read<std::uint8_t>();
        if (!from.ok() || width > static_cast<std::uint8_t>(ColourWidth::repeated))
            return Error{ErrorCode::corrupt, cat("unknown colour width ", width), {}, {}};
        width_ = static_cast<ColourWidth>(width);
    }
    return width_ == ColourWidth::wide ? decodeAs(words_, stratum, from, choices)
                                       : decodeAs(bytes_, stratum, from, choices);
}

template <class T>
Status ColourDecoder::decodeAs(std::array<std::vector<T>, 3>& known, int stratum, ByteReader& from,
                               NeighbourChoices choices) {
    std::size_t count = stratumPoints(pointCount_, stratum);
    auto coding = from.read<Coding>();
    if (!from.ok() || coding > Coding::plain || (coding == Coding::plain && channels_ != 1))
        return Error{ErrorCode::corrupt, "unknown way to store colours", {}, {}};
    std::array<std::vector<T>, 3> fresh;
    std::vector<T> green(count), predicted(count);
    for (std::size_t c = 0; c < channels_; ++c) {
        std::size_t channel = channels_ == 1 ? 0 : channelOrder[c];
        std::vector<T>& own = fresh[channel];
        own.resize(count);
        STIPPLE_CHECK(readPlane<T>(from, own));
        if (coding == Coding::plain)
            break;
        if (c == 0)
            green = own;
        else
            for (std::size_t j = 0; j < count; ++j)
                own[j] = static_cast<T>(own[j] + green[j]);
        if (stratum == 0) {
            T before = 0;
            for (T& value : own)
                before = value = static_cast<T>(value + before);
        } else {
            predictBetween<T>(known[channel], choices, predicted);
            for (std::size_t j = 0; j < count; ++j)
                own[j] = static_cast<T>(own[j] + predicted[j]);
        }
    }
    append<T>(fresh);
    for (std::size_t c = 0; c < channels_; ++c)
        if (stratum == 0)
            known[c] = std::move(fresh[c]);
        else
            merge<T>(known[c], fresh[c]);
    return {};
}

// Appends a stratum's values in progressive order.
template <class T>
void ColourDecoder::append(const std::array<std::vector<T>, 3>& fresh) {
    std::uint32_t unit = unitOf(width_);
    std::size_t count = fresh[0].size(), start = values_.size();
    values_.resize(start + count * channels_);
    std::uint16_t* to = values_.data() + start;
    const T *red = fresh[0].data(), *green = fresh[1].data(), *blue = fresh[2].data();
    std::vector<std::uint32_t> order = bitReversedOrder(static_cast<std::uint32_t>(count));
    if (channels_ == 1) {
        for (std::uint32_t j : order)
            *to++ = static_cast<std::uint16_t>(red[j] * unit);
        return;
    }
    for (std::uint32_t j : order) {
        to[0] = static_cast<std::uint16_t>(red[j] * unit);
        to[1] = static_cast<std::uint16_t>(green[j] * unit);
        to[2] = static_cast<std::uint16_t>(blue[j] * unit);
        to += 3;
    }
}

} // namespace stipple
