// One pulse to its returns: what a receiver would record along the beam.
//
// The beam starts with energy 1. A partial surface (leaf, wire) stops a random share of what arrives; glass
// now and then answers; water mostly swallows. What is stopped comes back by reflectance and angle and is a
// return if strong enough and far enough behind the one before. An opaque surface ends the beam.
#pragma once

#include "converter/synth/survey.hpp"

namespace stipple::synth {

struct Return {
    Vec3d position;       // scene coordinates, with range noise
    double range = 0;     // without noise
    double intensity = 0; // 0..1
    Rgb colour;
    Vec3d normal; // of the surface, towards the scanner; length 1
    std::uint8_t classification = 0, number = 0, count = 0;
};

class Scanner {
  public:
    // `noiseMeters`: deviation of the range error; 0 puts every return on the surface exactly.
    Scanner(const Scene& scene, std::uint64_t seed, double noiseMeters)
        : scene_(scene), seed_(seed), noise_(noiseMeters) {}

    // Replaces `returns` by those of pulse `index`, nearest first.
    void measure(const Source& source, std::uint64_t index, const Pulse& pulse,
                 std::vector<Return>& returns) const;
    // How many returns it has; the same, without the colour.
    std::size_t countReturns(const Source& source, std::uint64_t index) const;

  private:
    struct Echo {
        const Hit* hit;
        double energy; // stopped there
    };
    std::size_t echoes(const Source& source, std::uint64_t index, const Pulse& pulse, const HitList& hits,
                       Echo (&out)[16]) const;
    Rgb photograph(const Hit& hit, const Look& look, Random& random) const;

    const Scene& scene_;
    std::uint64_t seed_;
    double noise_;
};

} // namespace stipple::synth
