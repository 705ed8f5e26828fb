#include "shared/format/point_hash.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdio>

namespace stipple {

namespace {

// Odd constants without structure: XXH64's primes.
constexpr std::uint64_t multiplierA = 0x9E3779B185EBCA87ull;
constexpr std::uint64_t multiplierB = 0xC2B2AE3D27D4EB4Full;
constexpr std::uint64_t seedA = 0x27D4EB2F165667C5ull;
constexpr std::uint64_t seedB = 0x165667B19E3779F9ull;

std::uint64_t finish(std::uint64_t h) { // XXH64's avalanche
    h = (h ^ (h >> 33)) * multiplierB;
    h = (h ^ (h >> 29)) * seedB;
    return h ^ (h >> 32);
}

// Adds a 128-bit hash of one record of whole words: two independent lanes, each a chain of
// multiply and rotate, so every bit of every word reaches every bit of both.
void addRecord(PointHash& sum, const std::uint8_t* words, std::size_t count) {
    std::uint64_t a = seedA + count, b = seedB ^ count;
    for (std::size_t i = 0; i < count; ++i) {
        std::uint64_t word = loadLe<std::uint64_t>(words + 8 * i);
        a = std::rotl(a ^ (word * multiplierA), 29) * multiplierB;
        b = std::rotl(b + (word ^ (word >> 32)) * multiplierB, 37) * multiplierA;
    }
    sum.add(PointHash{finish(a ^ (b >> 17)), finish(b + std::rotl(a, 23))});
}

template <class Width>
void scatter(std::uint8_t* to, std::size_t stride, const std::uint8_t* from, std::size_t count, Width width) {
    for (std::size_t i = 0; i < count; ++i)
        std::memcpy(to + i * stride, from + i * width, width);
}

void scatterColumn(std::uint8_t* to, std::size_t stride, const std::uint8_t* from, std::size_t count,
                   std::size_t width) {
    switch (width) { // a constant width lets the compiler turn the copy into one move
    case 1:
        return scatter(to, stride, from, count, std::integral_constant<std::size_t, 1>{});
    case 2:
        return scatter(to, stride, from, count, std::integral_constant<std::size_t, 2>{});
    case 4:
        return scatter(to, stride, from, count, std::integral_constant<std::size_t, 4>{});
    case 8:
        return scatter(to, stride, from, count, std::integral_constant<std::size_t, 8>{});
    default:
        return scatter(to, stride, from, count, width);
    }
}

} // namespace

void PointHash::add(const Schema& schema, const PointBatch& batch) {
    // Records of some points at a time: x, y, z, the attributes without gaps, zeros up to a whole word.
    constexpr std::size_t group = 128;
    std::size_t words = 3 + (schema.bytesPerPoint() + 7) / 8, stride = 8 * words;
    Bytes records(group * stride);
    for (std::size_t first = 0; first < batch.size(); first += group) {
        std::size_t count = std::min(group, batch.size() - first);
        for (std::size_t i = 0; i < count; ++i)
            for (int axis = 0; axis < 3; ++axis)
                storeLe(records.data() + i * stride + static_cast<std::size_t>(8 * axis),
                        batch.positions[first + i][axis]);
        std::size_t at = 24;
        for (std::size_t a = 0; a < schema.attributes.size(); ++a) {
            std::size_t width = schema.attributes[a].size();
            scatterColumn(records.data() + at, stride, batch.columns[a].data() + first * width, count, width);
            at += width;
        }
        for (std::size_t i = 0; i < count; ++i)
            addRecord(*this, records.data() + i * stride, words);
    }
}

void PointHash::add(const PointHash& other) {
    low += other.low;
    high += other.high + (low < other.low ? 1 : 0);
}

std::string PointHash::hex() const {
    std::array<char, 33> text{};
    std::snprintf(text.data(), text.size(), "%016llx%016llx", static_cast<unsigned long long>(high),
                  static_cast<unsigned long long>(low));
    return text.data();
}

} // namespace stipple
