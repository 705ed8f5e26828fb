#include "tests/support/mutate.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <random>

namespace stipple::test {

namespace {

Mutation truncated(const Bytes& original, std::mt19937_64& random) {
    std::size_t size = random() % original.size();
    return {Bytes(original.begin(), original.begin() + static_cast<std::ptrdiff_t>(size)),
            cat("cut to ", size, " bytes"), size, size, false};
}

Mutation flippedBit(const Bytes& original, std::size_t at, std::mt19937_64& random) {
    Mutation mutation{original, cat("byte ", at, ": a bit flipped"), at, at + 1, true};
    mutation.bytes[at] = static_cast<std::uint8_t>(mutation.bytes[at] ^ (1u << (random() % 8)));
    return mutation;
}

// Numbers that arithmetic trips over, written across a field.
Mutation extremeNumber(const Bytes& original, std::size_t at, std::mt19937_64& random) {
    constexpr std::uint64_t extremes[] = {0,
                                          1,
                                          0x7FFFFFFFull,
                                          0x80000000ull,
                                          0xFFFFFFFFull,
                                          0x100000000ull,
                                          0x7FFFFFFFFFFFFFFFull,
                                          0x8000000000000000ull,
                                          ~0ull};
    std::uint64_t number = extremes[random() % std::size(extremes)];
    std::size_t width = std::min<std::size_t>(std::size_t{1} << (random() % 4), original.size() - at);
    Mutation mutation{original, cat("bytes ", at, "+", width, ": an extreme number"), at, at + width, true};
    std::memcpy(mutation.bytes.data() + at, &number, width);
    return mutation;
}

Mutation overwrittenRun(const Bytes& original, std::size_t at, std::mt19937_64& random) {
    std::size_t size = std::min<std::size_t>(1 + random() % 64, original.size() - at);
    bool zeros = random() % 2 == 0;
    Mutation mutation{original, cat("bytes ", at, "+", size, zeros ? ": zeros" : ": noise"), at, at + size,
                      true};
    for (std::size_t i = 0; i < size; ++i)
        mutation.bytes[at + i] = zeros ? std::uint8_t{0} : static_cast<std::uint8_t>(random());
    return mutation;
}

// A piece of the file repeated in place: what follows is shifted.
Mutation insertedPiece(const Bytes& original, std::size_t at, std::mt19937_64& random) {
    std::size_t size = std::min<std::size_t>(1 + random() % 32, original.size() - at);
    Mutation mutation{original, cat("byte ", at, ": ", size, " bytes doubled"), at, original.size(), false};
    Bytes piece(original.begin() + static_cast<std::ptrdiff_t>(at),
                original.begin() + static_cast<std::ptrdiff_t>(at + size));
    mutation.bytes.insert(mutation.bytes.begin() + static_cast<std::ptrdiff_t>(at), piece.begin(),
                          piece.end());
    return mutation;
}

} // namespace

Mutation mutate(const Bytes& original, std::uint64_t seed) {
    std::mt19937_64 random(seed * 0x9E3779B97F4A7C15ull + 1);
    // Half of the damage goes into the first 512 bytes, where the sizes and offsets are.
    std::size_t reach = random() % 2 == 0 ? std::min<std::size_t>(512, original.size()) : original.size();
    std::size_t at = random() % reach;
    switch (random() % 5) {
    case 0:
        return truncated(original, random);
    case 1:
        return flippedBit(original, at, random);
    case 2:
        return extremeNumber(original, at, random);
    case 3:
        return overwrittenRun(original, at, random);
    default:
        return insertedPiece(original, at, random);
    }
}

} // namespace stipple::test
