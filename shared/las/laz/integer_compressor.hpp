// Integers as corrections of a prediction (LASzip's IntegerCompressor): first k, the number of bits that
// the correction needs, by a model that the caller chooses with a context; then where in the 2^k numbers
// of that size it lies, its highest 8 bits by a model, the others as they are.
//
//   k = 0: 0, 1       k: -(2^k - 1) … -2^(k-1), 2^(k-1) + 1 … 2^k       k = 32: -2^31 alone
#pragma once

#include "shared/las/laz/arithmetic_decoder.hpp"
#include "shared/las/laz/arithmetic_encoder.hpp"

namespace stipple::las::laz {

// `Bits` (8, 16 or 32): values are 0 … 2^Bits - 1 and corrections wrap, or any int32. One object serves
// either a decoder or an encoder; init() before each stream.
template <unsigned Bits, unsigned Contexts = 1>
class IntegerCompressor {
  public:
    // What decompress() reads or compress() writes at most: two symbols and the raw bits.
    static constexpr std::size_t maxBytes = 8;

    void init() {
        for (auto& model : sizes_)
            model.init();
        zeroOrOne_.init();
        ready_.fill(false);
    }

    STIPPLE_LAZ_INLINE std::int32_t decompress(ArithmeticDecoder& from, std::int32_t predicted,
                                               unsigned context = 0) {
        return decompressBy(sizes_[context], from, predicted);
    }
    STIPPLE_LAZ_INLINE void compress(ArithmeticEncoder& to, std::int32_t predicted, std::int32_t value,
                                     unsigned context = 0) {
        compressBy(sizes_[context], to, predicted, value);
    }

    // With a model of sizes that the caller owns, where only running shows how many contexts there are.
    using SizeModel = SymbolModel<Bits + 1>;
    STIPPLE_LAZ_INLINE std::int32_t decompressBy(SizeModel& sizes, ArithmeticDecoder& from,
                                                 std::int32_t predicted) {
        auto value =
            static_cast<std::int32_t>(static_cast<std::uint32_t>(predicted) + readCorrection(from, sizes));
        if constexpr (Bits < 32) {
            if (value < 0)
                value += range;
            else if (value >= range)
                value -= range;
        }
        return value;
    }
    STIPPLE_LAZ_INLINE void compressBy(SizeModel& sizes, ArithmeticEncoder& to, std::int32_t predicted,
                                       std::int32_t value) {
        auto correction = static_cast<std::int32_t>(static_cast<std::uint32_t>(value) -
                                                    static_cast<std::uint32_t>(predicted));
        if constexpr (Bits < 32) {
            if (correction < -range / 2)
                correction += range;
            else if (correction > range / 2 - 1)
                correction -= range;
        }
        writeCorrection(to, correction, sizes);
    }

    // The k of the last correction, 0 … Bits: how well predictions work now, context for others.
    unsigned k() const { return k_; }

  private:
    static constexpr std::int32_t range = Bits < 32 ? static_cast<std::int32_t>(1u << (Bits % 32)) : 0;
    static constexpr unsigned modelledBits = 8;
    using PlaceModel = AdaptiveModel<256, false>;

    STIPPLE_LAZ_INLINE PlaceModel& places(unsigned k) {
        if (!ready_[k]) [[unlikely]] {
            places_[k].init(1u << (k < modelledBits ? k : modelledBits));
            ready_[k] = true;
        }
        return places_[k];
    }

    STIPPLE_LAZ_INLINE std::uint32_t readCorrection(ArithmeticDecoder& from, SizeModel& sizes) {
        const unsigned k = from.decodeSymbol(sizes);
        k_ = k;
        if (k == 0)
            return from.decodeBit(zeroOrOne_);
        if (k == 32)
            return 0x80000000u;
        std::uint32_t place = from.decodeSymbol(places(k));
        if (k > modelledBits) {
            const unsigned rawBits = k - modelledBits;
            place = (place << rawBits) | from.readBits(rawBits);
        }
        return place >= 1u << (k - 1) ? place + 1 : place - ((1u << k) - 1);
    }

    STIPPLE_LAZ_INLINE void writeCorrection(ArithmeticEncoder& to, std::int32_t correction,
                                            SizeModel& sizes) {
        const auto c = static_cast<std::uint32_t>(correction);
        const std::uint32_t size = correction <= 0 ? 0u - c : c - 1;
        const unsigned k = size == 0 ? 0 : 32 - static_cast<unsigned>(__builtin_clz(size));
        k_ = k;
        to.encodeSymbol(sizes, k);
        if (k == 0)
            return to.encodeBit(zeroOrOne_, c);
        if (k == 32)
            return;
        const std::uint32_t place = correction < 0 ? c + ((1u << k) - 1) : c - 1;
        if (k <= modelledBits)
            return to.encodeSymbol(places(k), place);
        const unsigned rawBits = k - modelledBits;
        to.encodeSymbol(places(k), place >> rawBits);
        to.writeBits(rawBits, place & ((1u << rawBits) - 1));
    }

    std::array<SizeModel, Contexts> sizes_;
    BitModel zeroOrOne_;
    unsigned k_ = 0;
    std::array<bool, Bits + 1> ready_{};
    std::array<PlaceModel, Bits + 1> places_; // made when first used
};

} // namespace stipple::las::laz
