#include "converter/synth/survey.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

// 12 June 2024, 10:00 UTC, as GPS seconds less 10^9 (LAS 1.4 "adjusted standard GPS time").
constexpr double surveyStart = 402'220'818;
constexpr double cruiseSpeed = 55;                          // m/s
constexpr double fastestPulses = 2e6, slowestPulses = 50e3; // a second
constexpr double lowestPolar = 0.03, highestPolar = 2.55;   // station: the tripod hides what is below
constexpr double stripShareOfTown = 0.6;

std::vector<Source> stripsOf(const Scene& scene) {
    std::vector<Source> strips;
    double side = scene.sideMeters();
    double above = std::clamp(0.6 * side, 240.0, 900.0);
    const auto& bounds = scene.bounds();
    double height = static_cast<double>(bounds.min.z) + above + 20;
    constexpr double halfAngle = 0.5;
    double swath = 2 * above * std::tan(halfAngle), spacing = swath * 0.55;
    // Off the axes of the scene, as wind and air space have it.
    constexpr double heading = 0.16;
    Vec3d along{std::cos(heading), std::sin(heading), 0}, across{-along.y, along.x, 0};
    double reach = side * 0.5 * (std::cos(heading) + std::sin(heading));
    auto count = static_cast<int>(std::ceil((2 * reach - swath * 0.6) / spacing)) + 1;
    auto add = [&](Vec3d direction, Vec3d offset) {
        Source s;
        s.kind = Source::Kind::strip;
        s.pointSourceId = static_cast<std::uint16_t>(strips.size() + 1);
        Vec3d middle = offset + Vec3d{0, 0, height};
        // Opposite headings by turns, and a lead of the angle the beam may look ahead.
        double sign = strips.size() % 2 == 0 ? 1 : -1;
        s.from = middle - direction * (sign * (reach + 8));
        s.to = middle + direction * (sign * (reach + 8));
        s.halfAngle = halfAngle;
        s.rangeLimit = 3 * above;
        strips.push_back(s);
    };
    for (int i = 0; i < count; ++i)
        add(along, across * ((i - (count - 1) * 0.5) * spacing));
    add(across, {0, 0, 0}); // a cross strip ties the block together
    strips.back().weight = 0.6;
    return strips;
}

std::vector<Source> stationsOf(const Scene& scene) {
    std::vector<Source> stations;
    bool indoor = scene.kind() == SceneKind::indoor;
    for (Vec3d position : scene.stations()) {
        Source s;
        s.kind = Source::Kind::station;
        s.pointSourceId = static_cast<std::uint16_t>(101 + stations.size());
        s.from = s.to = position;
        s.rangeLimit = indoor ? 60 : 150;
        s.maxReturns = 4;
        s.minSeparation = 0.15;
        stations.push_back(s);
    }
    return stations;
}

// Smooth wobble of the aircraft, radians or metres, `amplitude` large. Its four uses have periods of no
// common multiple.
double sway(double seconds, double periodSeconds, double phase, double amplitude) {
    return amplitude * std::sin(2 * pi / periodSeconds * seconds + phase);
}

} // namespace

std::vector<Source> planSources(const Scene& scene) {
    std::vector<Source> sources, stations;
    if (scene.kind() != SceneKind::indoor)
        sources = stripsOf(scene);
    if (scene.kind() != SceneKind::terrain)
        stations = stationsOf(scene);
    double stripWeight = 0;
    for (const Source& s : sources)
        stripWeight += s.weight;
    double share = sources.empty() ? 1 : 1 - stripShareOfTown;
    for (Source& s : stations)
        s.weight = share / static_cast<double>(stations.size());
    for (Source& s : sources)
        s.weight *= (stations.empty() ? 1 : stripShareOfTown) / stripWeight;
    sources.insert(sources.end(), stations.begin(), stations.end());
    // Five minutes from one start to the next.
    for (std::size_t i = 0; i < sources.size(); ++i)
        sources[i].startTime = surveyStart + 300.0 * static_cast<double>(i);
    return sources;
}

void planPulses(Source& s, double pulses) {
    pulses = std::max(pulses, 1.0);
    double patternWidth, patternHeight; // in one unit, so that spacing is alike both ways
    if (s.kind == Source::Kind::strip) {
        patternWidth = 2 * s.halfAngle * s.from.z;
        patternHeight = length(s.to - s.from);
    } else {
        patternWidth = highestPolar - lowestPolar;
        patternHeight = 2 * pi;
    }
    double spacing = std::sqrt(patternWidth * patternHeight / pulses);
    s.pulsesPerLine = static_cast<std::uint64_t>(std::max(1.0, std::round(patternWidth / spacing)));
    s.lines =
        static_cast<std::uint64_t>(std::max(1.0, std::ceil(pulses / static_cast<double>(s.pulsesPerLine))));
    // The aircraft keeps its speed while the laser can keep up, and flies slower beyond; a fifth of each
    // line's time is lost turning the mirror.
    double seconds = s.kind == Source::Kind::strip ? patternHeight / cruiseSpeed : 180;
    seconds = std::max(seconds, static_cast<double>(s.pulses()) / (0.8 * fastestPulses));
    s.lineSeconds = seconds / static_cast<double>(s.lines);
    s.pulseSeconds = std::min(0.8 * s.lineSeconds / static_cast<double>(s.pulsesPerLine), 1 / slowestPulses);
}

Pulse pulseOf(const Source& s, std::uint64_t seed, std::uint64_t index) {
    std::uint64_t pass = index / s.pulses(), inPass = index % s.pulses();
    std::uint64_t line = inPass / s.pulsesPerLine, inLine = inPass % s.pulsesPerLine;
    // Later passes fall between the lines of the first (steps of the golden ratio never repeat).
    double shift = std::fmod(static_cast<double>(pass) * 0.6180339887498949, 1.0);
    double across = (static_cast<double>(inLine) + 0.5) / static_cast<double>(s.pulsesPerLine);
    Pulse pulse;
    double inStrip = static_cast<double>(line) * s.lineSeconds + static_cast<double>(inLine) * s.pulseSeconds;
    double total = static_cast<double>(s.lines) * s.lineSeconds;
    pulse.time = s.startTime + static_cast<double>(pass) * (total + 20) + inStrip;
    pulse.lastOfLine = inLine + 1 == s.pulsesPerLine;
    // The mirror and the trigger are not perfect: a tenth of the spacing.
    Random random =
        Random(seed ^ 0x70756c73).child((static_cast<std::uint64_t>(s.pointSourceId) << 48) ^ index);
    double jitter = 0.3 * (random.uniform() - 0.5);
    if (s.kind == Source::Kind::strip) {
        pulse.leftToRight = line % 2 == 0;
        if (!pulse.leftToRight)
            across = 1 - across;
        across += jitter / static_cast<double>(s.pulsesPerLine);
        double travelled =
            (static_cast<double>(line) + shift + (inStrip / s.lineSeconds - static_cast<double>(line))) /
            static_cast<double>(s.lines);
        Vec3d path = s.to - s.from, forward = normalized(path), right{forward.y, -forward.x, 0};
        double phase = static_cast<double>(s.pointSourceId);
        double seconds = inStrip;
        Vec3d at = s.from + path * travelled + right * sway(seconds, 31, phase, 2) +
                   Vec3d{0, 0, sway(seconds, 23, phase + 1, 1.5)};
        double mirror = (2 * across - 1) * s.halfAngle;
        double roll = mirror + sway(seconds, 7, phase, 0.012), pitch = sway(seconds, 9, phase + 2, 0.010);
        pulse.scanAngleDegrees = mirror * 180 / pi;
        double c = std::cos(roll);
        pulse.ray = {at,
                     {right.x * std::sin(roll) + forward.x * std::sin(pitch) * c,
                      right.y * std::sin(roll) + forward.y * std::sin(pitch) * c, -std::cos(pitch) * c}};
    } else {
        pulse.leftToRight = true;
        double polar = lowestPolar + (across + jitter / static_cast<double>(s.pulsesPerLine)) *
                                         (highestPolar - lowestPolar);
        double turn = 2 * pi *
                      (static_cast<double>(line) + shift + across * 0.5 + 0.3 * (random.uniform() - 0.5)) /
                      static_cast<double>(s.lines);
        pulse.scanAngleDegrees = std::min(180.0, polar * 180 / pi - 90);
        pulse.ray = {s.from,
                     {std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn), std::cos(polar)}};
    }
    pulse.ray.direction = normalized(pulse.ray.direction);
    return pulse;
}

} // namespace stipple::synth
