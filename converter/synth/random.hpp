// Counter-based random numbers: value i of a stream is a hash of (key, i), so any thread can draw any
// value in any order and the scene or scan comes out the same.
//
// Mixing: the finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
// generators").
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

namespace stipple::synth {

inline std::uint64_t mix64(std::uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

class Random {
  public:
    explicit Random(std::uint64_t key) : key_(mix64(key)) {}

    // An independent stream for part `id` of what this stream makes.
    Random child(std::uint64_t id) const { return Random(key_ ^ mix64(id ^ 0x5851f42d4c957f2du)); }

    std::uint64_t bits() { return mix64(key_ + counter_++); }
    // In [0, 1).
    double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    // In [from, to], both included.
    int integer(int from, int to) {
        return from + static_cast<int>(bits() % static_cast<std::uint64_t>(to - from + 1));
    }
    bool chance(double probability) { return uniform() < probability; }
    // Mean 0, deviation 1 (Box and Muller 1958).
    double normal() { return normalPair().first; }
    // Two independent ones at little more than the price of one.
    std::pair<double, double> normalPair() {
        double radius = std::sqrt(-2 * std::log(1 - uniform())), turn = 2 * std::numbers::pi * uniform();
        return {radius * std::cos(turn), radius * std::sin(turn)};
    }

  private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

} // namespace stipple::synth
