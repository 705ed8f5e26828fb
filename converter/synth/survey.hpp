// Who scans, from where, and when each pulse leaves: airborne strips and terrestrial stations.
//
// Strip: an aircraft in straight flight, an oscillating mirror sweeps the beam across; lines alternate
// in direction. Station: a mirror spins about a horizontal axis while the head turns once around.
// Pulse `i` of a source is a pure function of the source and i.
#pragma once

#include "converter/synth/random.hpp"
#include "converter/synth/scene.hpp"

#include <cstdint>
#include <vector>

namespace stipple::synth {

struct Source {
    enum class Kind { strip, station };
    Kind kind = Kind::strip;
    std::uint16_t pointSourceId = 0;
    Vec3d from, to;         // strip: flight line; station: `from` is the mirror
    double halfAngle = 0.5; // strip: of the swath, radians
    double rangeLimit = 1000;
    int maxReturns = 7;
    double minSeparation = 0.4; // metres between two returns of a pulse that can be told apart
    double startTime = 0;       // adjusted standard GPS time, seconds
    double weight = 1;          // share of the points

    // Set by planPulses.
    std::uint64_t lines = 1, pulsesPerLine = 1;
    double lineSeconds = 0.01, pulseSeconds = 1e-6;

    std::uint64_t pulses() const { return lines * pulsesPerLine; }
};

struct Pulse {
    Ray ray; // unit direction
    double time = 0;
    double scanAngleDegrees = 0;
    bool leftToRight = false; // LAS "scan direction flag"
    bool lastOfLine = false;  // LAS "edge of flight line"
};

// The sources for a scene: strips for town and terrain, stations for town and indoor.
std::vector<Source> planSources(const Scene& scene);

// Lays out about `pulses` pulses over the source's pattern, and their times. Pulses past the end of the
// pattern start a second pass, shifted by a fraction of the spacing.
void planPulses(Source& source, double pulses);

Pulse pulseOf(const Source& source, std::uint64_t seed, std::uint64_t index);

} // namespace stipple::synth
