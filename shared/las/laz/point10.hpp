// The item POINT10: the 20 bytes that formats 0-5 begin with, versions 1 and 2.
//
//   0 X   4 Y   8 Z   12 intensity u16   14 returns, flags   15 classification   16 scan angle   17 user data
//   18 point source u16
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"
#include "shared/las/laz/streaming_median.hpp"

#include <algorithm>

namespace stipple::las::laz {

struct Point10 {
    static constexpr std::size_t size = 20;

    std::int32_t x = 0, y = 0, z = 0;
    std::uint16_t intensity = 0;
    std::uint8_t flags = 0, classification = 0, scanAngle = 0, userData = 0;
    std::uint16_t source = 0;

    static STIPPLE_LAZ_INLINE Point10 load(const std::uint8_t* from) {
        return {loadLe<std::int32_t>(from),
                loadLe<std::int32_t>(from + 4),
                loadLe<std::int32_t>(from + 8),
                loadLe<std::uint16_t>(from + 12),
                from[14],
                from[15],
                from[16],
                from[17],
                loadLe<std::uint16_t>(from + 18)};
    }
    STIPPLE_LAZ_INLINE void store(std::uint8_t* to) const {
        storeLe(to, x);
        storeLe(to + 4, y);
        storeLe(to + 8, z);
        storeLe(to + 12, intensity);
        to[14] = flags;
        to[15] = classification;
        to[16] = scanAngle;
        to[17] = userData;
        storeLe(to + 18, source);
    }

    unsigned returnNumber() const { return flags & 7u; }
    unsigned numberOfReturns() const { return (flags >> 3) & 7u; }
    unsigned scanDirection() const { return (flags >> 6) & 1u; }
};

// Which of 16 contexts a point belongs to, by number of returns and return number; those of pulses whose
// numbers make sense come first.
inline constexpr std::uint8_t returnContext[8][8] = {
    {15, 14, 13, 12, 11, 10, 9, 8},  {14, 0, 1, 3, 6, 10, 10, 9},    {13, 1, 2, 4, 7, 11, 11, 10},
    {12, 3, 4, 5, 8, 12, 12, 11},    {11, 6, 7, 8, 9, 13, 13, 12},   {10, 10, 11, 12, 13, 14, 14, 13},
    {9, 10, 11, 12, 13, 14, 15, 14}, {8, 9, 10, 11, 12, 13, 14, 15},
};

class Point10V2 {
  public:
    static constexpr std::size_t maxBytes = 64;

    void start(const std::uint8_t* first) {
        last_ = Point10::load(first);
        last_.intensity = 0; // as LASzip has it: the first intensity is known, but not used
        lastIntensity_.fill(0);
        lastHeight_.fill(0);
        xDifferences_.fill({});
        yDifferences_.fill({});
        changed_.init();
        flags_.reset();
        classification_.reset();
        userData_.reset();
        for (auto& model : scanAngle_)
            model.init();
        intensity_.init();
        source_.init();
        dx_.init();
        dy_.init();
        z_.init();
    }

    // Reads a point from `record` and encodes it, or decodes it into `record`.
    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        Point10 point = last_;
        if constexpr (encodes<Coder>)
            point = Point10::load(record);
        unsigned changed = 0;
        if constexpr (encodes<Coder>)
            changed = changes(point);
        changed = codeSymbol(coder, changed_, changed);
        if (changed & flagsBit)
            point.flags = static_cast<std::uint8_t>(codeSymbol(coder, flags_[last_.flags], point.flags));
        const unsigned r = point.returnNumber(), n = point.numberOfReturns();
        const unsigned context = returnContext[n][r];
        if (changed & intensityBit) {
            point.intensity = static_cast<std::uint16_t>(codeInteger(
                coder, intensity_, lastIntensity_[context], point.intensity, std::min(context, 3u)));
            lastIntensity_[context] = point.intensity;
        } else {
            point.intensity = lastIntensity_[context];
        }
        if (changed & (classificationBit | scanAngleBit | userDataBit | sourceBit)) {
            if (changed & classificationBit)
                point.classification = static_cast<std::uint8_t>(
                    codeSymbol(coder, classification_[last_.classification], point.classification));
            if (changed & scanAngleBit)
                point.scanAngle =
                    codeByte(coder, scanAngle_[point.scanDirection()], last_.scanAngle, point.scanAngle);
            if (changed & userDataBit)
                point.userData =
                    static_cast<std::uint8_t>(codeSymbol(coder, userData_[last_.userData], point.userData));
            if (changed & sourceBit)
                point.source =
                    static_cast<std::uint16_t>(codeInteger(coder, source_, last_.source, point.source));
        }
        codePosition(coder, point, r, n, context);
        last_ = point;
        if constexpr (!encodes<Coder>)
            point.store(record);
        return coder;
    }

  private:
    enum : unsigned {
        sourceBit = 1,
        userDataBit = 2,
        scanAngleBit = 4,
        classificationBit = 8,
        intensityBit = 16,
        flagsBit = 32
    };

    STIPPLE_LAZ_INLINE unsigned changes(const Point10& point) const {
        unsigned context = returnContext[point.numberOfReturns()][point.returnNumber()];
        return (point.source != last_.source ? sourceBit : 0u) |
               (point.userData != last_.userData ? userDataBit : 0u) |
               (point.scanAngle != last_.scanAngle ? scanAngleBit : 0u) |
               (point.classification != last_.classification ? classificationBit : 0u) |
               (point.intensity != lastIntensity_[context] ? intensityBit : 0u) |
               (point.flags != last_.flags ? flagsBit : 0u);
    }

    template <class Coder>
    STIPPLE_LAZ_INLINE void codePosition(Coder& coder, Point10& point, unsigned r, unsigned n,
                                         unsigned context) {
        const unsigned single = n == 1;
        const unsigned level = n > r ? n - r : r - n;
        // How far the corrections of x and y reached says how far those of y and z may.
        auto evenUpTo = [](unsigned bits, unsigned most) { return bits < most ? bits & ~1u : most; };
        std::int32_t dx =
            codeInteger(coder, dx_, xDifferences_[context].get(), wrapSubtract(point.x, last_.x), single);
        xDifferences_[context].add(dx);
        std::int32_t dy = codeInteger(coder, dy_, yDifferences_[context].get(),
                                      wrapSubtract(point.y, last_.y), single + evenUpTo(dx_.k(), 20));
        yDifferences_[context].add(dy);
        point.x = wrapAdd(last_.x, dx);
        point.y = wrapAdd(last_.y, dy);
        point.z = codeInteger(coder, z_, lastHeight_[level], point.z,
                              single + evenUpTo((dx_.k() + dy_.k()) / 2, 18));
        lastHeight_[level] = point.z;
    }

    Point10 last_;
    std::array<std::uint16_t, 16> lastIntensity_;
    std::array<std::int32_t, 8> lastHeight_;
    std::array<StreamingMedian5, 16> xDifferences_, yDifferences_;
    SymbolModel<64> changed_;
    std::array<SymbolModel<256>, 2> scanAngle_;
    IntegerCompressor<16, 4> intensity_;
    IntegerCompressor<16> source_;
    IntegerCompressor<32, 2> dx_;
    IntegerCompressor<32, 22> dy_;
    IntegerCompressor<32, 20> z_;
    LazyModels<SymbolModel<256>, 256> flags_, classification_, userData_;
};

// Version 1 (LASzip 1.x).
class Point10V1 {
  public:
    static constexpr std::size_t maxBytes = 64;

    void start(const std::uint8_t* first) {
        last_ = Point10::load(first);
        xDifferences_.fill(0);
        yDifferences_.fill(0);
        next_ = 0;
        changed_.init();
        flags_.reset();
        classification_.reset();
        userData_.reset();
        intensity_.init();
        scanAngle_.init();
        source_.init();
        dx_.init();
        dy_.init();
        z_.init();
    }

    template <class Coder, class Byte>
    Coder code(Coder coder, Byte* record) {
        Point10 point = last_;
        if constexpr (encodes<Coder>)
            point = Point10::load(record);
        std::int32_t dx = codeInteger(coder, dx_, median(xDifferences_), wrapSubtract(point.x, last_.x));
        unsigned bits = dx_.k();
        std::int32_t dy = codeInteger(coder, dy_, median(yDifferences_), wrapSubtract(point.y, last_.y),
                                      std::min(bits, 19u));
        bits = (bits + dy_.k()) / 2;
        point.x = wrapAdd(last_.x, dx);
        point.y = wrapAdd(last_.y, dy);
        point.z = codeInteger(coder, z_, last_.z, point.z, std::min(bits, 19u));
        codeOthers(coder, point, bits);
        xDifferences_[next_] = dx;
        yDifferences_[next_] = dy;
        next_ = next_ == 2 ? 0 : next_ + 1;
        last_ = point;
        if constexpr (!encodes<Coder>)
            point.store(record);
        return coder;
    }

  private:
    enum : unsigned {
        sourceBit = 1,
        userDataBit = 2,
        scanAngleBit = 4,
        classificationBit = 8,
        flagsBit = 16,
        intensityBit = 32
    };

    template <class Coder>
    STIPPLE_LAZ_INLINE void codeOthers(Coder& coder, Point10& point, unsigned bits) {
        unsigned changed = (point.source != last_.source ? sourceBit : 0u) |
                           (point.userData != last_.userData ? userDataBit : 0u) |
                           (point.scanAngle != last_.scanAngle ? scanAngleBit : 0u) |
                           (point.classification != last_.classification ? classificationBit : 0u) |
                           (point.flags != last_.flags ? flagsBit : 0u) |
                           (point.intensity != last_.intensity ? intensityBit : 0u);
        changed = codeSymbol(coder, changed_, changed);
        if (changed & intensityBit)
            point.intensity =
                static_cast<std::uint16_t>(codeInteger(coder, intensity_, last_.intensity, point.intensity));
        if (changed & flagsBit)
            point.flags = static_cast<std::uint8_t>(codeSymbol(coder, flags_[last_.flags], point.flags));
        if (changed & classificationBit)
            point.classification = static_cast<std::uint8_t>(
                codeSymbol(coder, classification_[last_.classification], point.classification));
        if (changed & scanAngleBit)
            point.scanAngle = static_cast<std::uint8_t>(
                codeInteger(coder, scanAngle_, last_.scanAngle, point.scanAngle, bits < 3));
        if (changed & userDataBit)
            point.userData =
                static_cast<std::uint8_t>(codeSymbol(coder, userData_[last_.userData], point.userData));
        if (changed & sourceBit)
            point.source =
                static_cast<std::uint16_t>(codeInteger(coder, source_, last_.source, point.source));
    }

    static std::int32_t median(const std::array<std::int32_t, 3>& of) {
        return std::max(std::min(of[0], of[1]), std::min(std::max(of[0], of[1]), of[2]));
    }

    Point10 last_;
    std::array<std::int32_t, 3> xDifferences_, yDifferences_; // the last three, in a ring
    std::size_t next_ = 0;
    SymbolModel<64> changed_;
    IntegerCompressor<16> intensity_, source_;
    IntegerCompressor<8, 2> scanAngle_;
    IntegerCompressor<32> dx_;
    IntegerCompressor<32, 20> dy_, z_;
    LazyModels<SymbolModel<256>, 256> flags_, classification_, userData_;
};

} // namespace stipple::las::laz
