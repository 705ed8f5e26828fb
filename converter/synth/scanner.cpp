#include "converter/synth/scanner.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

constexpr double weakestEcho = 0.06; // of the energy sent, before reflectance
const Vec3d sun = normalized({0.45, -0.55, 0.85});

Random randomOf(std::uint64_t seed, const Source& source, std::uint64_t index, std::uint64_t use) {
    return Random(seed ^ use).child((static_cast<std::uint64_t>(source.pointSourceId) << 48) ^ index);
}

// The share of the beam that a surface stops.
double stoppedShare(Interception how, double cosine, Random& random) {
    switch (how) {
    case Interception::opaque:
        return 1;
    case Interception::partial:
        return random.uniform(0.25, 0.85);
    case Interception::pane:
        return random.chance(0.08) ? 1.0 : 0.0;
    case Interception::water:
        // Specular: a lobe about the vertical, and a rest from ripples.
        return random.chance(0.03 + 0.75 * std::pow(cosine, 24)) ? 1.0 : 0.0;
    }
    return 1;
}

} // namespace

std::size_t Scanner::echoes(const Source& source, std::uint64_t index, const Pulse& pulse,
                            const HitList& hits, Echo (&out)[16]) const {
    Random random = randomOf(seed_, source, index, 0x6563686f);
    double energy = 1, lastRange = -1e9;
    std::size_t count = 0;
    for (const Hit& hit : hits) {
        double cosine = std::abs(dot(hit.normal, pulse.ray.direction));
        double stopped = energy * stoppedShare(materialInfo(hit.material).interception, cosine, random);
        energy -= stopped;
        bool heard = stopped > weakestEcho && hit.distance - lastRange > source.minSeparation;
        if (heard && count < static_cast<std::size_t>(source.maxReturns)) {
            out[count++] = {&hit, stopped};
            lastRange = hit.distance;
        }
        if (energy < weakestEcho)
            break;
    }
    return count;
}

std::size_t Scanner::countReturns(const Source& source, std::uint64_t index) const {
    Pulse pulse = pulseOf(source, seed_, index);
    HitList hits;
    scene_.castRay(pulse.ray, source.rangeLimit, hits);
    Echo found[16];
    return echoes(source, index, pulse, hits, found);
}

Rgb Scanner::photograph(const Hit& hit, const Look& look, Random& random) const {
    double light;
    if (scene_.kind() == SceneKind::indoor) {
        // Lamps on every ceiling: soft light from above, a little less in corners that face down.
        light = 0.62 + 0.28 * std::abs(hit.normal.z) + 0.06 * hit.normal.x + 0.04 * hit.normal.y;
    } else {
        double facing = dot(hit.normal, sun), direct = 0;
        if (look.sunlit >= 0) // leaves glow through
            direct = (0.35 + 0.65 * std::abs(facing)) * static_cast<double>(look.sunlit);
        else if (facing > 0)
            direct = facing * scene_.lightAlong({hit.position + hit.normal * 2e-3, sun});
        light = 0.42 + 0.12 * hit.normal.z + 0.68 * direct;
    }
    auto grain = static_cast<float>(light * random.uniform(0.95, 1.05));
    return look.colour * grain;
}

void Scanner::measure(const Source& source, std::uint64_t index, const Pulse& pulse,
                      std::vector<Return>& returns) const {
    returns.clear();
    HitList hits;
    scene_.castRay(pulse.ray, source.rangeLimit, hits);
    Echo found[16];
    std::size_t count = echoes(source, index, pulse, hits, found);
    Random random = randomOf(seed_, source, index, 0x72616e67);
    double nominal = source.kind == Source::Kind::strip ? source.from.z : 15;
    for (std::size_t i = 0; i < count; ++i) {
        const Hit& hit = *found[i].hit;
        Look look = scene_.lookAt(hit);
        Return r;
        r.range = hit.distance;
        auto [rangeError, powerError] = random.normalPair();
        r.position = hit.position + pulse.ray.direction * (noise_ * rangeError);
        double cosine = std::abs(dot(hit.normal, pulse.ray.direction));
        // Falls with the range's square, levelled near by as receivers do.
        double spread = std::min(1.3, (nominal * nominal) /
                                          std::max(hit.distance * hit.distance, 0.5 * nominal * nominal));
        r.intensity = found[i].energy * static_cast<double>(look.reflectance) * (0.15 + 0.85 * cosine) *
                      spread * (1 + 0.04 * powerError);
        r.colour = photograph(hit, look, random);
        r.normal = hit.normal * (dot(hit.normal, pulse.ray.direction) > 0 ? -1.0 : 1.0);
        r.classification = look.classification;
        r.number = static_cast<std::uint8_t>(i + 1);
        r.count = static_cast<std::uint8_t>(count);
        returns.push_back(r);
    }
}

} // namespace stipple::synth
