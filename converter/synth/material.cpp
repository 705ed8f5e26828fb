#include "converter/synth/material.hpp"

#include <array>

namespace stipple::synth {

namespace {

using enum Interception;
namespace c = classes;

constexpr std::array<MaterialInfo, static_cast<std::size_t>(Material::count)> table = {{
    {"ground", c::ground, {0.36f, 0.42f, 0.22f}, 0.40f, opaque, -1, 0.7f, 0.15f},
    {"kerb", c::ground, {0.62f, 0.61f, 0.58f}, 0.45f, opaque, -1, 0.4f, 0.10f},
    {"water", c::water, {0.16f, 0.25f, 0.26f}, 0.08f, water, -1, 3.0f, 0.12f},
    {"wall", c::building, {0.86f, 0.82f, 0.74f}, 0.55f, opaque, 0, 1.3f, 0.08f},
    {"inner wall", c::building, {0.88f, 0.86f, 0.82f}, 0.65f, opaque, -1, 1.0f, 0.04f},
    {"roof tiles", c::building, {0.60f, 0.27f, 0.18f}, 0.35f, opaque, 1, 0.35f, 0.22f},
    {"flat roof", c::building, {0.47f, 0.46f, 0.44f}, 0.30f, opaque, -1, 0.5f, 0.15f},
    {"concrete", c::building, {0.60f, 0.59f, 0.56f}, 0.42f, opaque, -1, 0.8f, 0.12f},
    {"stone", c::building, {0.66f, 0.60f, 0.50f}, 0.45f, opaque, -1, 0.5f, 0.18f},
    {"brick", c::building, {0.55f, 0.28f, 0.21f}, 0.38f, opaque, -1, 0.25f, 0.20f},
    {"chimney", c::building, {0.48f, 0.25f, 0.20f}, 0.35f, opaque, -1, 0.2f, 0.20f},
    {"solar panel", c::building, {0.07f, 0.09f, 0.18f}, 0.06f, opaque, -1, 0.5f, 0.20f},
    {"gutter", c::building, {0.42f, 0.45f, 0.45f}, 0.50f, opaque, -1, 0.0f, 0.0f},
    {"glass", c::window, {0.30f, 0.38f, 0.42f}, 0.10f, pane, -1, 0.0f, 0.0f},
    {"window frame", c::window, {0.92f, 0.92f, 0.90f}, 0.60f, opaque, -1, 0.0f, 0.0f},
    {"door", c::door, {0.42f, 0.24f, 0.14f}, 0.40f, opaque, -1, 0.3f, 0.15f},
    {"wooden floor", c::floor, {0.60f, 0.43f, 0.27f}, 0.45f, opaque, -1, 0.3f, 0.20f},
    {"tiled floor", c::floor, {0.70f, 0.69f, 0.66f}, 0.48f, opaque, -1, 0.5f, 0.08f},
    {"carpet", c::floor, {0.29f, 0.34f, 0.43f}, 0.30f, opaque, -1, 0.1f, 0.20f},
    {"ceiling", c::ceiling, {0.93f, 0.93f, 0.91f}, 0.75f, opaque, -1, 0.8f, 0.04f},
    {"stairs", c::stairs, {0.58f, 0.56f, 0.53f}, 0.45f, opaque, -1, 0.4f, 0.10f},
    {"wood", c::furniture, {0.63f, 0.47f, 0.30f}, 0.50f, opaque, -1, 0.25f, 0.20f},
    {"white board", c::furniture, {0.95f, 0.95f, 0.96f}, 0.70f, opaque, -1, 0.0f, 0.0f},
    {"fabric", c::furniture, {0.35f, 0.20f, 0.22f}, 0.35f, opaque, -1, 0.1f, 0.20f},
    {"books", c::furniture, {0.45f, 0.33f, 0.28f}, 0.35f, opaque, -1, 0.05f, 0.80f},
    {"screen", c::furniture, {0.06f, 0.06f, 0.07f}, 0.07f, opaque, -1, 0.0f, 0.0f},
    {"plastic", c::furniture, {0.78f, 0.79f, 0.80f}, 0.50f, opaque, -1, 0.0f, 0.0f},
    {"lamp shade", c::lamp, {0.98f, 0.95f, 0.84f}, 0.70f, opaque, -1, 0.0f, 0.0f},
    {"broad leaves", c::highVegetation, {0.24f, 0.40f, 0.13f}, 0.50f, partial, 0, 0.5f, 0.35f},
    {"needles", c::highVegetation, {0.13f, 0.27f, 0.14f}, 0.38f, partial, 0, 0.4f, 0.35f},
    {"hedge leaves", c::mediumVegetation, {0.20f, 0.36f, 0.12f}, 0.48f, partial, 0, 0.3f, 0.35f},
    {"bark", c::highVegetation, {0.33f, 0.26f, 0.20f}, 0.35f, opaque, -1, 0.15f, 0.25f},
    {"conductor", c::conductor, {0.50f, 0.51f, 0.53f}, 0.35f, partial, -1, 0.0f, 0.0f},
    {"guard wire", c::guardWire, {0.45f, 0.46f, 0.48f}, 0.35f, partial, -1, 0.0f, 0.0f},
    {"lattice", c::tower, {0.52f, 0.55f, 0.55f}, 0.45f, partial, -1, 0.5f, 0.10f},
    {"insulator", c::tower, {0.35f, 0.22f, 0.16f}, 0.30f, partial, -1, 0.0f, 0.0f},
    {"wooden pole", c::tower, {0.35f, 0.27f, 0.20f}, 0.38f, opaque, -1, 0.3f, 0.20f},
    {"car paint", c::vehicle, {0.60f, 0.60f, 0.62f}, 0.40f, opaque, 0, 0.0f, 0.0f},
    {"car glass", c::vehicle, {0.10f, 0.12f, 0.14f}, 0.07f, opaque, -1, 0.0f, 0.0f},
    {"rubber", c::vehicle, {0.07f, 0.07f, 0.07f}, 0.06f, opaque, -1, 0.0f, 0.0f},
    {"lamp post", c::streetFurniture, {0.30f, 0.34f, 0.33f}, 0.40f, opaque, -1, 0.0f, 0.0f},
    {"bridge deck", c::bridge, {0.35f, 0.35f, 0.36f}, 0.25f, opaque, -1, 0.5f, 0.12f},
    {"bridge concrete", c::bridge, {0.64f, 0.62f, 0.58f}, 0.45f, opaque, -1, 0.8f, 0.12f},
    {"railing", c::streetFurniture, {0.40f, 0.42f, 0.43f}, 0.40f, opaque, -1, 0.0f, 0.0f},
    {"timber", c::building, {0.50f, 0.37f, 0.24f}, 0.48f, opaque, -1, 0.25f, 0.18f},
    {"marking", c::bridge, {0.90f, 0.90f, 0.88f}, 0.70f, opaque, -1, 0.1f, 0.05f},
    {"sign", c::streetFurniture, {0.75f, 0.15f, 0.15f}, 0.80f, opaque, -1, 0.0f, 0.0f},
    {"footing", c::tower, {0.62f, 0.61f, 0.58f}, 0.42f, opaque, -1, 0.4f, 0.10f},
}};

} // namespace

const MaterialInfo& materialInfo(Material material) {
    return table[static_cast<std::size_t>(material)];
}

} // namespace stipple::synth
