#include "converter/synth/noise.hpp"

#include "converter/synth/random.hpp"

#include <algorithm>

namespace stipple::synth {

namespace {

double lattice(std::uint64_t seed, std::int64_t x, std::int64_t y) {
    std::uint64_t bits = mix64(seed ^ (static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15u) ^
                               (static_cast<std::uint64_t>(y) * 0xc2b2ae3d27d4eb4fu));
    return static_cast<double>(bits >> 11) * 0x1p-52 - 1;
}

double fade(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

} // namespace

double valueNoise(std::uint64_t seed, double x, double y) {
    double fx = std::floor(x), fy = std::floor(y);
    auto ix = static_cast<std::int64_t>(fx), iy = static_cast<std::int64_t>(fy);
    double tx = fade(x - fx), ty = fade(y - fy);
    double a = lattice(seed, ix, iy), b = lattice(seed, ix + 1, iy);
    double c = lattice(seed, ix, iy + 1), d = lattice(seed, ix + 1, iy + 1);
    double low = a + (b - a) * tx, high = c + (d - c) * tx;
    return low + (high - low) * ty;
}

double fractalNoise(std::uint64_t seed, double x, double y, int octaves) {
    double sum = 0, amplitude = 0.5;
    for (int i = 0; i < octaves; ++i) {
        sum += amplitude * valueNoise(seed + static_cast<std::uint64_t>(i), x, y);
        amplitude *= 0.5;
        // A turn between octaves hides the lattice.
        double turnedX = 1.6 * x - 1.2 * y;
        y = 1.2 * x + 1.6 * y;
        x = turnedX;
    }
    return sum;
}

double smoothStep(double from, double to, double x) {
    double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

} // namespace stipple::synth
