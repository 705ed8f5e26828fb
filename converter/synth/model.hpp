// A list of primitives with the ways to add to it: what furniture, houses and trees are modelled with.
// Coordinates are metres in the model's own frame: z up, 0 at the floor it stands on.
#pragma once

#include "converter/synth/primitive.hpp"

#include <numbers>
#include <span>
#include <vector>

namespace stipple::synth {

inline constexpr double pi = std::numbers::pi;

struct Vec2d {
    double x = 0, y = 0;
    friend Vec2d operator+(Vec2d a, Vec2d b) { return {a.x + b.x, a.y + b.y}; }
    friend Vec2d operator-(Vec2d a, Vec2d b) { return {a.x - b.x, a.y - b.y}; }
    friend Vec2d operator*(Vec2d a, double s) { return {a.x * s, a.y * s}; }
};

struct Model {
    std::vector<Primitive> primitives;

    void triangle(Vec3d a, Vec3d b, Vec3d c, Material material, std::uint32_t tag = 0);
    void quad(Vec3d a, Vec3d b, Vec3d c, Vec3d d, Material material, std::uint32_t tag = 0);
    void box(Vec3d min, Vec3d max, Material material);
    // A box of size (x, y, z) whose bottom centre stands at `at`, turned by `yaw` about z.
    void standingBox(Vec3d at, Vec3d size, double yaw, Material material);
    void cylinder(Vec3d from, Vec3d to, double radius, Material material) {
        frustum(from, to, radius, radius, material);
    }
    void frustum(Vec3d from, Vec3d to, double radius, double radiusEnd, Material material);
    void disc(Vec3d centre, Vec3d normal, double radius, Material material);
    void sphere(Vec3d centre, double radius, Material material);
    // A wire of `segments` cylinders hanging from `from` to `to` with the lowest point about `sag` below the
    // chord: a catenary in its parabolic approximation (exact to sag²/span).
    void wire(Vec3d from, Vec3d to, double sag, int segments, double radius, Material material);

    void append(const Model& part, Vec3d at, double yaw = 0);
};

// A hole in a wall, and what fills it. `from` and `to` run along the wall, `sill` and `head` are heights.
struct Opening {
    enum class Kind { window, openWindow, door, hole };
    double from, to, sill, head;
    Kind kind = Kind::window;
};

// A wall with thickness that stands on the line a-b; its outer face looks to the right of a→b, its inner
// one is `thickness` behind. Openings get reveals, frames, panes and door leaves; they must not overlap.
struct Wall {
    Vec2d a, b;
    double bottom, top, thickness;
    Material outer, inner;
    std::vector<Opening> openings;
};
void addWall(Model& model, const Wall& wall);

// A slab with at most one rectangular hole (minimum and maximum corner), as an opening for stairs.
struct Slab {
    Vec2d min, max;
    double bottom, top;
    Material above, below, edge;
    bool hasHole = false;
    Vec2d holeMin{}, holeMax{};
};
void addSlab(Model& model, const Slab& slab);

// Straight stairs that start at `foot` and climb `rise` over `run` in the direction `yaw`.
void addStairs(Model& model, Vec3d foot, double yaw, double width, double run, double rise, int steps,
               Material material);

} // namespace stipple::synth
