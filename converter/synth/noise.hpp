// Smooth noise over the plane, for relief and textures. Pure functions of (seed, x, y).
#pragma once

#include <cstdint>

namespace stipple::synth {

// Value noise with quintic interpolation, lattice spacing 1; in [-1, 1].
double valueNoise(std::uint64_t seed, double x, double y);

// Sum of `octaves` noises, each with twice the frequency and half the height of the one before; in about [-1,
// 1].
double fractalNoise(std::uint64_t seed, double x, double y, int octaves);

// 0 below `from`, 1 above `to`, smooth between.
double smoothStep(double from, double to, double x);

} // namespace stipple::synth
