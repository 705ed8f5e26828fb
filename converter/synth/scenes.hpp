// The three scenes (internal; callers use Scene::make).
#pragma once

#include "converter/synth/scene.hpp"

namespace stipple::synth {

// Streets on a bent grid, a river with a bridge, houses, a church, tower blocks, a park, a power line.
std::unique_ptr<const Scene> makeTown(std::uint64_t seed, double sideMeters);
// One building: three storeys of rooms along a corridor, stairs, furniture.
std::unique_ptr<const Scene> makeIndoor(std::uint64_t seed);
// Hills with forest, fields, a river, a road, a power line.
std::unique_ptr<const Scene> makeTerrain(std::uint64_t seed, double sideMeters);

} // namespace stipple::synth
