// The GPS time layer of POINT14: only of the points where the time changed. Times are doubles taken as 64-bit
// integers, whose differences are small and regular within a flight line; up to four lines ("sequences")
// that alternate are followed at once.
#pragma once

#include "shared/base/bytes.hpp"
#include "shared/las/laz/layered_layer.hpp"

namespace stipple::las::laz {

class GpsTimeSequences {
  public:
    void begin(std::uint64_t last) {
        sequences_.fill({});
        sequences_[0].time = last;
        current_ = newest_ = 0;
        multiples_.init();
        firstSteps_.init();
        steps_.init();
    }

    STIPPLE_LAZ_INLINE std::uint64_t read(LayerReader& from) {
        // A writer changes the sequence once at most; damaged bytes might go on for ever.
        for (int changes = 0; changes < 4; ++changes) {
            Sequence& sequence = sequences_[current_];
            unsigned code;
            if (sequence.step == 0) {
                code = from.symbol(firstSteps_, 0);
                if (code == 0) {
                    takeFirstStep(sequence, from.integer(steps_, 0, 0, 0));
                    return sequence.time;
                }
                --code;
            } else {
                code = from.symbol(multiples_, 0);
                if (code < newSequence) {
                    Guess guess = guessStep(sequence, code);
                    takeStep(sequence, code, from.integer(steps_, guess.step, 0, guess.context));
                    return sequence.time;
                }
                code -= newSequence;
            }
            if (code == 0) {
                std::uint64_t high = static_cast<std::uint32_t>(
                    from.integer(steps_, static_cast<std::int32_t>(sequence.time >> 32), 0, 8));
                openSequence(high << 32 | from.word(0));
                break;
            }
            current_ = (current_ + code) & 3;
        }
        return sequences_[current_].time;
    }

    STIPPLE_LAZ_INLINE void write(LayerWriter& to, std::uint64_t time) {
        for (;;) {
            Sequence& sequence = sequences_[current_];
            if (reaches(sequence, time)) {
                const auto step = static_cast<std::int32_t>(time - sequence.time);
                if (sequence.step == 0) {
                    to.symbol(firstSteps_, 0);
                    to.integer(steps_, 0, step, 0);
                    takeFirstStep(sequence, step);
                } else {
                    unsigned code = codeOfStep(step, sequence.step);
                    Guess guess = guessStep(sequence, code);
                    to.symbol(multiples_, code);
                    to.integer(steps_, guess.step, step, guess.context);
                    takeStep(sequence, code, step);
                }
                return;
            }
            unsigned other = 1;
            while (other < 4 && !reaches(sequences_[(current_ + other) & 3], time))
                ++other;
            const unsigned code = other & 3;
            if (sequence.step == 0)
                to.symbol(firstSteps_, 1 + code);
            else
                to.symbol(multiples_, newSequence + code);
            if (code == 0) {
                to.integer(steps_, static_cast<std::int32_t>(sequence.time >> 32),
                           static_cast<std::int32_t>(time >> 32), 8);
                to.word(static_cast<std::uint32_t>(time));
                openSequence(time);
                return;
            }
            current_ = (current_ + code) & 3;
        }
    }

  private:
    struct Sequence {
        std::uint64_t time = 0;
        std::int32_t step = 0;
        std::uint32_t extremes = 0; // steps in a row that no multiple described well
    };
    struct Guess {
        std::int32_t step;
        unsigned context;
    };

    // Codes of a step as a multiple of the sequence's: 0 … 499 times, 500 times or more, -1 … -9 times,
    // -10 times or less; then a new sequence, and the next, second and third sequence.
    static constexpr unsigned many = 500, backwards = 500, manyBackwards = 510, newSequence = 511;

    static bool reaches(const Sequence& sequence, std::uint64_t time) {
        auto difference = static_cast<std::int64_t>(time - sequence.time);
        return difference == static_cast<std::int32_t>(difference);
    }

    static unsigned codeOfStep(std::int32_t step, std::int32_t of) {
        float ratio = static_cast<float>(step) / static_cast<float>(of);
        if (ratio >= static_cast<float>(many))
            return many;
        if (ratio <= -10.0f)
            return manyBackwards;
        int rounded = static_cast<int>(ratio >= 0 ? ratio + 0.5f : ratio - 0.5f);
        if (rounded == -10)
            return manyBackwards;
        return static_cast<unsigned>(rounded >= 0 ? rounded : static_cast<int>(backwards) - rounded);
    }

    static STIPPLE_LAZ_INLINE Guess guessStep(const Sequence& sequence, unsigned code) {
        auto times = [&](std::uint32_t factor) {
            return static_cast<std::int32_t>(factor * static_cast<std::uint32_t>(sequence.step));
        };
        if (code == 1)
            return {sequence.step, 1};
        if (code == 0)
            return {0, 7};
        if (code < many)
            return {times(code), code < 10 ? 2u : 3u};
        if (code == many)
            return {times(many), 4};
        return {times(backwards - code), code < manyBackwards ? 5u : 6u};
    }

    static STIPPLE_LAZ_INLINE void takeStep(Sequence& sequence, unsigned code, std::int32_t step) {
        sequence.time += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
        if (code == 1) {
            sequence.extremes = 0;
        } else if (code == 0 || code == many || code == manyBackwards) {
            if (++sequence.extremes > 3) {
                sequence.step = step;
                sequence.extremes = 0;
            }
        }
    }

    static STIPPLE_LAZ_INLINE void takeFirstStep(Sequence& sequence, std::int32_t step) {
        sequence.time += static_cast<std::uint64_t>(static_cast<std::int64_t>(step));
        sequence.step = step;
        sequence.extremes = 0;
    }

    // The oldest of the four makes room.
    void openSequence(std::uint64_t time) {
        current_ = newest_ = (newest_ + 1) & 3;
        sequences_[current_] = {time, 0, 0};
    }

    std::array<Sequence, 4> sequences_;
    unsigned current_ = 0, newest_ = 0;
    SymbolModel<newSequence + 4> multiples_;
    SymbolModel<5> firstSteps_;
    IntegerCompressor<32, 9> steps_;
};

class GpsTimeLayer {
  public:
    static constexpr std::size_t maxBytes = 18;
    static constexpr std::size_t offsetBytes = 22;

    void start(unsigned channel, const std::uint8_t* record) {
        channels_.start(channel, loadLe<std::uint64_t>(record + offsetBytes));
    }

    template <class Stream>
    STIPPLE_LAZ_INLINE void codePoint(Stream& stream, PointInfo point, typename Stream::Byte* record) {
        auto [state, last] = channels_.choose(point.channel());
        auto* field = record + offsetBytes;
        if constexpr (Stream::writing) {
            if (point.gpsTimeChanged()) {
                last = loadLe<std::uint64_t>(field);
                state.write(stream, last);
            }
        } else {
            if (point.gpsTimeChanged())
                last = state.read(stream);
            storeLe(field, last);
        }
    }

  private:
    Channels<GpsTimeSequences, std::uint64_t> channels_;
};

} // namespace stipple::las::laz
