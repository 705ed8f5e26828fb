// The item GPSTIME11: the GPS time of formats 1 and 3-5, its 64 bits taken as an integer, versions 1 and 2.
// Times of one sequence differ by about a multiple of their last difference; version 2 follows four
// sequences.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/coding.hpp"

#include <cmath>

namespace stipple::las::laz {

// a / b to the nearest whole number, in the single precision that LASzip takes.
inline std::int32_t nearestMultiple(std::int32_t a, std::int32_t b) {
    float ratio = static_cast<float>(a) / static_cast<float>(b);
    float rounded = ratio >= 0 ? ratio + 0.5f : ratio - 0.5f;
    constexpr float limit = 1e9f; // far above every multiple that has a code
    return static_cast<std::int32_t>(std::fmin(std::fmax(rounded, -limit), limit));
}

class GpsTime11V2 {
  public:
    static constexpr std::size_t size = 8;
    static constexpr std::size_t maxBytes = 40;

    void start(const std::uint8_t* first) {
        sequences_.fill({});
        sequences_[0].time = loadLe<std::uint64_t>(first);
        current_ = newest_ = 0;
        multiple_.init();
        fromStandstill_.init();
        difference_.init();
    }

    ArithmeticDecoder code(ArithmeticDecoder from, std::uint8_t* to) {
        // An encoder changes to a sequence that then has the time: a second change comes from damaged bytes.
        for (int change = 0; change < 2 && decodeOnce(from); ++change) {
        }
        storeLe(to, sequences_[current_].time);
        return from;
    }

    ArithmeticEncoder code(ArithmeticEncoder to, const std::uint8_t* from) {
        const auto time = loadLe<std::uint64_t>(from);
        while (encodeOnce(to, time)) {
        }
        return to;
    }

  private:
    struct Sequence {
        std::uint64_t time = 0;
        std::int32_t difference = 0;
        int extremes = 0; // multiples beyond the codes, one after the other
    };

    static constexpr int most = 500, least = -10; // multiples that have a code
    static constexpr unsigned unchanged = most - least + 1, fullTime = unchanged + 1;
    static constexpr unsigned symbols = fullTime + 4;

    static STIPPLE_LAZ_INLINE void advance(Sequence& sequence, std::int32_t by) {
        sequence.time += static_cast<std::uint64_t>(static_cast<std::int64_t>(by));
    }
    // After a few multiples out of range the last difference becomes the new unit.
    static STIPPLE_LAZ_INLINE void countExtreme(Sequence& sequence, std::int32_t difference) {
        if (++sequence.extremes > 3) {
            sequence.difference = difference;
            sequence.extremes = 0;
        }
    }
    void beginSequence(std::uint64_t time) {
        newest_ = (newest_ + 1) & 3;
        current_ = newest_;
        sequences_[current_] = {time, 0, 0};
    }

    STIPPLE_LAZ_INLINE std::uint64_t decodeFullTime(ArithmeticDecoder& from) {
        auto high = static_cast<std::int32_t>(sequences_[current_].time >> 32);
        high = difference_.decompress(from, high, 8);
        return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32) | from.readInt();
    }

    // True: it only changed to another sequence.
    STIPPLE_LAZ_INLINE bool decodeOnce(ArithmeticDecoder& from) {
        Sequence& sequence = sequences_[current_];
        if (sequence.difference == 0) {
            unsigned code = from.decodeSymbol(fromStandstill_);
            if (code == 1) {
                sequence.difference = difference_.decompress(from, 0, 0);
                advance(sequence, sequence.difference);
                sequence.extremes = 0;
            } else if (code == 2) {
                beginSequence(decodeFullTime(from));
            } else if (code > 2) {
                current_ = (current_ + code - 2) & 3;
                return true;
            }
            return false;
        }
        const unsigned code = from.decodeSymbol(multiple_);
        if (code == 1) {
            advance(sequence, difference_.decompress(from, sequence.difference, 1));
            sequence.extremes = 0;
        } else if (code < unchanged) {
            advance(sequence, decodeMultiple(from, sequence, static_cast<int>(code)));
        } else if (code == fullTime) {
            beginSequence(decodeFullTime(from));
        } else if (code > fullTime) {
            current_ = (current_ + code - fullTime) & 3;
            return true;
        }
        return false;
    }

    // Codes: 0; 2 … most; then -1 … least.
    STIPPLE_LAZ_INLINE std::int32_t decodeMultiple(ArithmeticDecoder& from, Sequence& sequence, int code) {
        const bool extreme = code == 0 || code == most || code == most - least;
        const int multiple = code <= most ? code : most - code;
        std::int32_t difference =
            difference_.decompress(from, wrapMultiply(multiple, sequence.difference), contextOf(multiple));
        if (extreme)
            countExtreme(sequence, difference);
        return difference;
    }
    static unsigned contextOf(int multiple) {
        if (multiple == 0)
            return 7;
        if (multiple > 0)
            return multiple < 10 ? 2 : multiple < most ? 3 : 4;
        return multiple > least ? 5 : 6;
    }

    // True: it only changed to another sequence.
    bool encodeOnce(ArithmeticEncoder& to, std::uint64_t time) {
        Sequence& sequence = sequences_[current_];
        const bool standstill = sequence.difference == 0;
        if (time == sequence.time) {
            if (standstill)
                to.encodeSymbol(fromStandstill_, 0);
            else
                to.encodeSymbol(multiple_, unchanged);
            return false;
        }
        if (!isNear(sequence, time)) {
            unsigned full = standstill ? 2 : fullTime;
            unsigned other = 1;
            while (other < 4 && !isNear(sequences_[(current_ + other) & 3], time))
                ++other;
            unsigned code = other < 4 ? full + other : full;
            if (standstill)
                to.encodeSymbol(fromStandstill_, code);
            else
                to.encodeSymbol(multiple_, code);
            if (other < 4) {
                current_ = (current_ + other) & 3;
                return true;
            }
            difference_.compress(to, static_cast<std::int32_t>(sequence.time >> 32),
                                 static_cast<std::int32_t>(time >> 32), 8);
            to.writeInt(static_cast<std::uint32_t>(time));
            beginSequence(time);
            return false;
        }
        auto difference = static_cast<std::int32_t>(time - sequence.time);
        if (standstill) {
            to.encodeSymbol(fromStandstill_, 1);
            difference_.compress(to, 0, difference, 0);
            sequence.difference = difference;
            sequence.extremes = 0;
        } else {
            encodeMultiple(to, sequence, difference);
        }
        sequence.time = time;
        return false;
    }

    static bool isNear(const Sequence& sequence, std::uint64_t time) {
        auto difference = static_cast<std::int64_t>(time - sequence.time);
        return difference == static_cast<std::int32_t>(difference);
    }

    void encodeMultiple(ArithmeticEncoder& to, Sequence& sequence, std::int32_t difference) {
        int multiple = nearestMultiple(difference, sequence.difference);
        if (multiple == 1) {
            to.encodeSymbol(multiple_, 1);
            difference_.compress(to, sequence.difference, difference, 1);
            sequence.extremes = 0;
            return;
        }
        multiple = multiple > most ? most : multiple < least ? least : multiple;
        to.encodeSymbol(multiple_, static_cast<unsigned>(multiple >= 0 ? multiple : most - multiple));
        difference_.compress(to, wrapMultiply(multiple, sequence.difference), difference,
                             contextOf(multiple));
        if (multiple == 0 || multiple == most || multiple == least)
            countExtreme(sequence, difference);
    }

    std::array<Sequence, 4> sequences_;
    unsigned current_ = 0, newest_ = 0;
    SymbolModel<symbols> multiple_;
    SymbolModel<6> fromStandstill_;
    IntegerCompressor<32, 9> difference_;
};

// Version 1 (LASzip 1.x): one sequence.
class GpsTime11V1 {
  public:
    static constexpr std::size_t size = 8;
    static constexpr std::size_t maxBytes = 24;

    void start(const std::uint8_t* first) {
        time_ = loadLe<std::uint64_t>(first);
        unit_ = 0;
        extremes_ = 0;
        multiple_.init();
        fromStandstill_.init();
        difference_.init();
    }

    ArithmeticDecoder code(ArithmeticDecoder from, std::uint8_t* to) {
        if (unit_ == 0) {
            unsigned code = from.decodeSymbol(fromStandstill_);
            if (code == 1)
                advance(unit_ = difference_.decompress(from, 0, 0));
            else if (code == 2)
                time_ = from.readInt64();
        } else {
            unsigned code = from.decodeSymbol(multiple_);
            if (code < fullTime) {
                int multiple = static_cast<int>(code);
                std::int32_t difference =
                    difference_.decompress(from, prediction(multiple), contextOf(multiple));
                advance(difference);
                learn(multiple, difference);
            } else if (code == fullTime) {
                time_ = from.readInt64();
            }
        }
        storeLe(to, time_);
        return from;
    }

    ArithmeticEncoder code(ArithmeticEncoder to, const std::uint8_t* from) {
        const auto time = loadLe<std::uint64_t>(from);
        const auto wide = static_cast<std::int64_t>(time - time_);
        const auto difference = static_cast<std::int32_t>(wide);
        const bool near = difference == wide;
        time_ = time;
        if (unit_ == 0) {
            to.encodeSymbol(fromStandstill_, wide == 0 ? 0 : near ? 1 : 2);
            if (wide != 0 && near)
                difference_.compress(to, 0, unit_ = difference, 0);
            else if (wide != 0)
                to.writeInt64(time);
        } else if (wide == 0) {
            to.encodeSymbol(multiple_, unchanged);
        } else if (!near) {
            to.encodeSymbol(multiple_, fullTime);
            to.writeInt64(time);
        } else {
            int multiple = std::min(std::max(nearestMultiple(difference, unit_), 0), most);
            to.encodeSymbol(multiple_, static_cast<unsigned>(multiple));
            difference_.compress(to, prediction(multiple), difference, contextOf(multiple));
            learn(multiple, difference);
        }
        return to;
    }

  private:
    static constexpr int most = 509;
    static constexpr unsigned fullTime = most + 1, unchanged = fullTime + 1;

    void advance(std::int32_t by) { time_ += static_cast<std::uint64_t>(static_cast<std::int64_t>(by)); }
    std::int32_t prediction(int multiple) const {
        return multiple == 0 ? unit_ / 4 : wrapMultiply(multiple, unit_);
    }
    static unsigned contextOf(int multiple) {
        return multiple == 0 ? 2 : multiple == 1 ? 1 : multiple < 10 ? 3 : multiple < 50 ? 4 : 5;
    }
    // The unit follows the differences, and jumps after a few that are out of range.
    void learn(int multiple, std::int32_t difference) {
        if (multiple == 1 || ((multiple == 0 || multiple == most) && ++extremes_ > 3)) {
            unit_ = difference;
            extremes_ = 0;
        }
    }

    std::uint64_t time_ = 0;
    std::int32_t unit_ = 0;
    int extremes_ = 0;
    SymbolModel<unchanged + 1> multiple_;
    SymbolModel<3> fromStandstill_;
    IntegerCompressor<32, 6> difference_;
};

} // namespace stipple::las::laz
