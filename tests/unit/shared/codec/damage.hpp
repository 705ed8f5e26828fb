// Damaged copies of bytes, each in memory of just its size so that a sanitizer sees any read past it.
#pragma once

#include "shared/base/bytes.hpp"

#include <random>

namespace stipple::test {

// Calls `visit` with each prefix of `bytes`, the whole left out (with gaps, if there are very many), and
// with `flips` copies that have one to three bits flipped.
template <class Visit>
void forEachDamage(const Bytes& bytes, int flips, const Visit& visit) {
    std::size_t gap = std::max<std::size_t>(1, bytes.size() / 400);
    for (std::size_t size = 0; size < bytes.size(); size += gap)
        visit(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size)));
    std::mt19937 random(5);
    for (int i = 0; i < flips && !bytes.empty(); ++i) {
        Bytes damaged = bytes;
        for (unsigned flip = 0; flip <= random() % 3; ++flip)
            damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1u << (random() % 8));
        visit(damaged);
    }
}

} // namespace stipple::test
