// Adaptive probabilities of the arithmetic coder of LAZ: FastAC (A. Said, "Introduction to arithmetic
// coding", 2004) with the constants of LASzip. Decoder and encoder count the same symbols and renew the
// distribution after the same number of them, so both know it without a word in the stream.
//
// A model is plain memory: no allocation, nothing to release. It is not usable before init().
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

// The hot loops keep the coder's state in registers; that needs every step inlined.
#if defined(__GNUC__)
#define STIPPLE_LAZ_INLINE __attribute__((always_inline)) inline
#define STIPPLE_LAZ_COLD __attribute__((noinline))
#else
#define STIPPLE_LAZ_INLINE inline
#define STIPPLE_LAZ_COLD
#endif

namespace stipple::las::laz {

// The interval is kept at this length or above; each byte that leaves makes it 256 times as long.
inline constexpr std::uint32_t minIntervalLength = 1u << 24;

// A bit with an adaptive probability, in 13 bits.
struct BitModel {
    static constexpr unsigned precision = 13;

    std::uint32_t zeroProbability = 1u << (precision - 1);
    std::uint32_t zeroCount = 1, bitCount = 2;
    std::uint32_t cycle = 4, untilUpdate = 4;

    void init() { *this = BitModel{}; }

    STIPPLE_LAZ_COLD void update() {
        bitCount += cycle;
        if (bitCount > 1u << precision) {
            bitCount = (bitCount + 1) >> 1;
            zeroCount = (zeroCount + 1) >> 1;
            if (zeroCount == bitCount)
                ++bitCount;
        }
        std::uint32_t scale = 0x80000000u / bitCount;
        zeroProbability = (zeroCount * scale) >> (31 - precision);
        cycle = (5 * cycle) >> 2;
        if (cycle > 64)
            cycle = 64;
        untilUpdate = cycle;
    }
};

// Up to `Capacity` symbols with adaptive probabilities, in 15 bits. `Fixed`: exactly that many, known when
// compiling; otherwise init() says how many (2 … Capacity).
//
// distribution[s] is the probability of all symbols before s: at least one more for each symbol, so
// no interval ever becomes empty; behind the last symbol a value above any. table[v >> tableShift] is the
// last symbol that begins at or before that part of the range: where the search for v starts. There are at
// least twice as many parts as symbols, so it mostly ends there, too.
template <unsigned Capacity, bool Fixed>
class AdaptiveModel {
  public:
    static constexpr unsigned precision = 15;
    static constexpr std::uint32_t maxTotal = 1u << precision;
    static_assert(Capacity >= 2 && Capacity <= 2048);

    STIPPLE_LAZ_INLINE unsigned symbols() const { return Fixed ? Capacity : symbols_; }
    STIPPLE_LAZ_INLINE unsigned tableShift() const {
        return Fixed ? precision - tableBits(Capacity) : shift_;
    }

    void init(unsigned symbols = Capacity) {
        symbols_ = static_cast<std::uint16_t>(symbols);
        shift_ = static_cast<std::uint16_t>(precision - tableBits(symbols));
        total_ = 0;
        cycle_ = symbols;
        for (unsigned k = 0; k < symbols; ++k)
            count[k] = 1;
        distribution[symbols] = aboveAll;
        update<true>();
        cycle_ = untilUpdate = (symbols + 6) >> 1;
    }

    // Turns the counts into the distribution and, for decoding, its table.
    template <bool ForDecoding>
    STIPPLE_LAZ_COLD void update() {
        const unsigned n = symbols();
        total_ += cycle_;
        if (total_ > maxTotal) {
            total_ = 0;
            for (unsigned k = 0; k < n; ++k) {
                count[k] = static_cast<std::uint16_t>((count[k] + 1) >> 1);
                total_ += count[k];
            }
        }
        const std::uint32_t scale = 0x80000000u / total_;
        std::uint32_t sum = 0;
        likely = nothingLikely;
        for (unsigned k = 0; k < n; ++k) {
            distribution[k] = static_cast<std::uint16_t>((scale * sum) >> (31 - precision));
            sum += count[k];
            if constexpr (ForDecoding)
                if (count[k] > total_ / 2)
                    likely = k;
        }
        if constexpr (ForDecoding)
            buildTable();
        cycle_ = (5 * cycle_) >> 2;
        const std::uint32_t longest = (n + 6) << 3;
        if (cycle_ > longest)
            cycle_ = longest;
        untilUpdate = cycle_;
    }

    // The last symbol that begins at or before `scaled`, a little above 2^15 at most.
    STIPPLE_LAZ_INLINE unsigned find(std::uint32_t scaled) const {
        unsigned symbol = table[scaled >> tableShift()];
        while (distribution[symbol + 1] <= scaled)
            ++symbol;
        return symbol;
    }

  private:
    using Index = std::conditional_t<Capacity <= 256, std::uint8_t, std::uint16_t>;
    static constexpr std::uint16_t aboveAll = 0xFFFF;
    // A step that divides was rounded down from at least 2^9: the quotient is at most 2^15 + 63, so with
    // parts of 64 or more it lies at most one part beyond the range.
    static constexpr unsigned mostTableBits = precision - 6;

    static constexpr unsigned tableBits(unsigned symbols) {
        unsigned bits = 3;
        while (1u << bits < 2 * symbols && bits < mostTableBits)
            ++bits;
        return bits;
    }

    void buildTable() {
        const unsigned n = symbols(), shift = tableShift(), size = 1u << (precision - shift);
        unsigned part = 0;
        for (unsigned k = 0; k + 1 < n; ++k)
            for (unsigned next = distribution[k + 1]; part << shift < next; ++part)
                table[part] = static_cast<Index>(k);
        // And the part beyond the range.
        for (; part <= size; ++part)
            table[part] = static_cast<Index>(n - 1);
    }

  public:
    std::array<std::uint16_t, Capacity + 1> distribution;
    std::array<std::uint16_t, Capacity> count; // at most maxTotal and a cycle, below 2^16
    std::uint32_t untilUpdate;
    // For decoding: the symbol that more than half of all so far are.
    static constexpr std::uint32_t nothingLikely = 0xFFFFFFFF;
    std::uint32_t likely;

  private:
    std::uint32_t total_, cycle_;
    std::uint16_t symbols_, shift_;
    std::array<Index, (1u << tableBits(Capacity)) + 1> table;
};

template <unsigned Symbols>
using SymbolModel = AdaptiveModel<Symbols, true>;

// Models that only some streams need, one for each value of a byte: made when first asked for.
template <class Model, std::size_t Count>
class LazyModels {
  public:
    void reset() { ready_.fill(false); }
    STIPPLE_LAZ_INLINE Model& operator[](std::size_t i) {
        if (!ready_[i]) [[unlikely]] {
            models_[i].init();
            ready_[i] = true;
        }
        return models_[i];
    }

  private:
    std::array<bool, Count> ready_{};
    std::array<Model, Count> models_;
};

} // namespace stipple::las::laz
