// What surfaces are made of, as a scanner and a camera see it.
#pragma once

#include <cstdint>

namespace stipple::synth {

struct Rgb {
    float r = 0, g = 0, b = 0; // 0..1, linear enough for a point colour
    friend Rgb operator*(Rgb c, float s) { return {c.r * s, c.g * s, c.b * s}; }
    friend Rgb operator+(Rgb a, Rgb b) { return {a.r + b.r, a.g + b.g, a.b + b.b}; }
};

inline Rgb mix(Rgb a, Rgb b, float t) {
    return a * (1 - t) + b * t;
}

// Classification codes: LAS 1.4 R15 table 17; 64 and up are "user definable" and this simulator's own.
namespace classes {
inline constexpr std::uint8_t ground = 2, lowVegetation = 3, mediumVegetation = 4, highVegetation = 5;
inline constexpr std::uint8_t building = 6, water = 9, road = 11, guardWire = 13, conductor = 14, tower = 15;
inline constexpr std::uint8_t bridge = 17;
inline constexpr std::uint8_t floor = 64, ceiling = 65, stairs = 66, door = 67, window = 68, furniture = 69;
inline constexpr std::uint8_t lamp = 70, vehicle = 71, streetFurniture = 72;
} // namespace classes

enum class Material : std::uint8_t {
    ground, // textured by the plan of the scene (GroundPlan)
    kerb,
    water,
    wall, // tint 0
    wallInside,
    roof, // tint 1
    roofFlat,
    concrete,
    stone,
    brick,
    chimney,
    solarPanel,
    gutter,
    glass,
    windowFrame,
    door,
    floorWood,
    floorTile,
    carpet,
    ceiling,
    stairs,
    wood,
    whiteBoard,
    fabric,
    books,
    screen,
    plastic,
    lampShade,
    leafBroad,  // tint 0
    leafNeedle, // tint 0
    leafHedge,  // tint 0
    bark,
    conductor,
    guardWire,
    lattice,
    insulator,
    woodPole,
    carPaint, // tint 0
    carGlass,
    rubber,
    lampPost,
    bridgeDeck,
    bridgeConcrete,
    railing,
    timber,   // of buildings
    marking,  // painted on a bridge
    signFace, // of a traffic sign
    footing,  // of a pylon
    count
};

// How a beam meets the material.
enum class Interception : std::uint8_t {
    opaque,  // all of the beam is stopped
    partial, // the surface is smaller than the footprint: part of the beam goes on
    pane,    // glass: now and then a return, mostly let through
    water,   // mostly swallowed; a return is likely near the vertical only
};

struct MaterialInfo {
    const char* name;
    std::uint8_t classification; // of vegetation: by height instead (Scene::lookAt)
    Rgb colour;
    float reflectance; // in the near infrared, 0..1, at normal incidence
    Interception interception;
    std::int8_t tint;   // which colour of the object it takes: 0, 1, or -1 for its own
    float textureScale; // metres of the brightness noise; 0: none
    float textureDepth; // its height, 0..1
};

const MaterialInfo& materialInfo(Material material);

} // namespace stipple::synth
