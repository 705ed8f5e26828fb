#include "shared/codec/colour_codec.hpp"

#include "shared/base/text.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/codec/section.hpp"

#include <algorithm>

namespace stipple {

namespace {

// Prediction of the value at `i` from what earlier strata (or, in stratum 0, the point before) have told.
template <class Get>
std::uint32_t predict(const Get& get, std::size_t i, std::size_t half, std::size_t step, std::size_t size,
                      int stratum) {
    if (stratum == 0)
        return i == 0 ? 0 : get(i - step);
    std::uint32_t low = get(i - half);
    return i + half < size ? (low + get(i + half) + 1) / 2 : low;
}

// Channels are coded green first; red and blue as what their change differs from green's.
constexpr std::size_t channelOrder[3] = {1, 0, 2};

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

// [u8 width, in stratum 0] [per channel: section of low bytes of residuals, section of high bytes if wide]
void encodeColour(ByteWriter& to, std::span<const std::uint16_t> values, std::uint32_t pointCount,
                  int channels, ColourWidth width, int stratum) {
    if (stratum == 0)
        to.write(static_cast<std::uint8_t>(width));
    auto channelCount = static_cast<std::size_t>(channels);
    std::size_t first = stratumFirst(stratum), step = stratumStep(stratum);
    std::size_t count = stratumPoints(pointCount, stratum);
    bool wide = width == ColourWidth::wide;
    std::uint32_t divisor = width == ColourWidth::high ? 256 : width == ColourWidth::repeated ? 257 : 1;
    std::vector<std::uint16_t> change(count, 0); // of the first channel coded
    Bytes low(count), high(wide ? count : 0);
    for (std::size_t c = 0; c < channelCount; ++c) {
        std::size_t channel = channels == 1 ? 0 : channelOrder[c];
        auto get = [&](std::size_t i) { return values[i * channelCount + channel] / divisor; };
        for (std::size_t j = 0; j < count; ++j) {
            std::size_t i = first + j * step;
            auto own = static_cast<std::uint16_t>(get(i) - predict(get, i, first, step, pointCount, stratum));
            auto residual = static_cast<std::uint16_t>(own - change[j]);
            if (c == 0)
                change[j] = own;
            low[j] = static_cast<std::uint8_t>(residual);
            if (wide)
                high[j] = static_cast<std::uint8_t>(residual >> 8);
        }
        writeSection(to, low, Effort::literals);
        if (wide)
            writeSection(to, high, Effort::literals);
    }
}

ColourDecoder::ColourDecoder(std::uint32_t pointCount, int channels, int strata)
    : pointCount_(pointCount), spacing_(8u >> (strata - 1)),
      planes_(static_cast<std::size_t>(channels),
              std::vector<std::uint16_t>(strataPrefixPoints(pointCount, strata))) {}

Status ColourDecoder::decode(int stratum, ByteReader& from) {
    if (stratum == 0) {
        auto width = from.read<std::uint8_t>();
        if (!from.ok() || width > static_cast<std::uint8_t>(ColourWidth::repeated))
            return Error{ErrorCode::corrupt, cat("unknown colour width ", width), {}, {}};
        width_ = static_cast<ColourWidth>(width);
    }
    std::size_t first = stratumFirst(stratum) / spacing_, step = stratumStep(stratum) / spacing_;
    std::size_t count = stratumPoints(pointCount_, stratum);
    bool wide = width_ == ColourWidth::wide;
    std::uint32_t mask = wide ? 0xFFFF : 0xFF;
    std::vector<std::uint16_t> change(count, 0);
    Bytes low(count), high(wide ? count : 0);
    for (std::size_t c = 0; c < planes_.size(); ++c) {
        auto& plane = planes_[planes_.size() == 1 ? 0 : channelOrder[c]];
        auto get = [&](std::size_t i) { return std::uint32_t{plane[i]}; };
        STIPPLE_CHECK(readFullSection(from, low));
        if (wide)
            STIPPLE_CHECK(readFullSection(from, high));
        for (std::size_t j = 0; j < count; ++j) {
            std::size_t i = first + j * step;
            auto own = static_cast<std::uint16_t>(low[j] + (wide ? high[j] << 8 : 0) + change[j]);
            if (c == 0)
                change[j] = own;
            plane[i] = static_cast<std::uint16_t>(
                (predict(get, i, first, step, plane.size(), stratum) + own) & mask);
        }
    }
    decoded_ = stratum + 1;
    return {};
}

void ColourDecoder::values(std::vector<std::uint16_t>& to) const {
    std::uint32_t factor = width_ == ColourWidth::high ? 256 : width_ == ColourWidth::repeated ? 257 : 1;
    to.resize(std::size_t{strataPrefixPoints(pointCount_, decoded_)} * planes_.size());
    std::size_t out = 0;
    for (int stratum = 0; stratum < decoded_; ++stratum) {
        std::size_t first = stratumFirst(stratum) / spacing_, step = stratumStep(stratum) / spacing_;
        for (std::uint32_t j : bitReversedOrder(stratumPoints(pointCount_, stratum)))
            for (const auto& plane : planes_)
                to[out++] = static_cast<std::uint16_t>(plane[first + j * step] * factor);
    }
}

} // namespace stipple
