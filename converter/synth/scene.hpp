// A procedural scene with an exact surface, to be scanned and to judge scans by.
//
// Coordinates here are *scene coordinates*: metres, z up, relative to origin(); a LAS point of the scan is
// `integer × 0.001 + origin()`. Everything is a function of kind, seed and size; immutable after it is
// made, so any number of threads may ask at once.
#pragma once

#include "converter/synth/bvh.hpp"
#include "converter/synth/ground.hpp"
#include "converter/synth/model.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace stipple::synth {

enum class SceneKind { town, indoor, terrain };

// One crossing of a ray with the surface.
struct Hit {
    double distance = noHit; // in units of the ray's direction
    Vec3d position;          // on the surface, to about 1e-10 m
    Vec3d normal;            // unit, on the side the ray comes from
    Material material = Material::ground;
    std::uint32_t object = 0;    // which instance: 0 is the ground (or the building, indoors)
    std::uint32_t primitive = 0; // of its mesh
};

// The crossings of one ray in order of distance: partial ones (leaves, wires, panes) and, last, the first
// opaque one if there is any. Rays through more than `capacity` surfaces keep the nearest.
struct HitList {
    static constexpr std::size_t capacity = 16;
    std::array<Hit, capacity> hits;
    std::size_t size = 0;
    const Hit* begin() const { return hits.data(); }
    const Hit* end() const { return hits.data() + size; }
};

// What a camera and a classifier see at a hit.
struct Look {
    Rgb colour;               // of the material, not lit
    float reflectance = 0.5f; // near infrared, 0..1
    std::uint8_t classification = 0;
    // Leaves: how much sun gets there, by the height in the crown; others: negative, ask lightAlong().
    float sunlit = -1;
};

// A model that has been given its search structure. Shared by all its instances.
struct Mesh {
    explicit Mesh(Model model);
    std::vector<Primitive> primitives;
    Bvh bvh;
};

// A mesh placed in the scene: turned about z, scaled, moved.
struct Instance {
    std::uint32_t mesh = 0;
    Vec3d position;
    double yaw = 0, scale = 1;
    std::array<Rgb, 2> tints{};
};

class Scene {
  public:
    // `sideMeters`: of the square that town and terrain cover; the building of an indoor scene has a fixed
    // size.
    static std::unique_ptr<const Scene> make(SceneKind kind, std::uint64_t seed, double sideMeters);

    SceneKind kind() const { return kind_; }
    std::uint64_t seed() const { return seed_; }
    // World position of scene coordinate (0, 0, 0): UTM, metres.
    Vec3d origin() const { return {500000, 5400000, 0}; }
    const Box<float>& bounds() const { return bvh_.bounds(); }
    double sideMeters() const { return side_; }
    // Places where someone would set up a terrestrial scanner: free of obstacles, about eye height.
    const std::vector<Vec3d>& stations() const { return stations_; }
    std::size_t objectCount() const { return placed_.size(); }
    std::size_t primitiveCount() const; // of all instances

    // All crossings up to the first opaque surface, none beyond `maxDistance` (units of the direction).
    void castRay(const Ray& ray, double maxDistance, HitList& hits) const;
    // How much light comes along the ray from afar: 0 behind anything opaque, 1 where nothing is in the way.
    double lightAlong(const Ray& ray) const;

    // Distance from a point to the nearest surface of anything; exact (about 1e-9 m).
    double distanceToSurface(Vec3d point) const;
    // Height of the ground, without what stands on it; nothing outside the scene.
    std::optional<double> heightAt(double x, double y) const;

    Look lookAt(const Hit& hit) const;

  private:
    friend class SceneBuilder;
    struct Placed {
        Instance instance;
        double cosYaw, sinYaw;
        Ray toLocal(const Ray& ray) const;
        Vec3d toLocal(Vec3d point) const;
        Vec3d turnBack(Vec3d direction) const;
    };
    const Mesh& meshOf(const Placed& placed) const { return meshes_[placed.instance.mesh]; }

    SceneKind kind_ = SceneKind::town;
    std::uint64_t seed_ = 0;
    double side_ = 0;
    std::vector<Mesh> meshes_;
    std::vector<Placed> placed_;         // in object order
    std::vector<std::uint32_t> byPlace_; // the order of bvh_
    Bvh bvh_;
    std::unique_ptr<const Ground> ground_; // its mesh is object 0; null indoors
    std::vector<Vec3d> stations_;
};

// Collects meshes and instances. The first instance is the ground where there is one.
class SceneBuilder {
  public:
    SceneBuilder(SceneKind kind, std::uint64_t seed, double sideMeters);
    std::uint32_t addMesh(Model model);
    void place(const Instance& instance);
    // A mesh used once, where it was modelled.
    void placeOnce(Model model, std::array<Rgb, 2> tints = {});
    void setGround(std::unique_ptr<const Ground> ground);
    const Ground& ground() const { return *scene_->ground_; }
    // A wish for a station: when all is built, the first of these positions with nothing within 0.45 m.
    void station(std::vector<Vec3d> positions) { wishes_.push_back(std::move(positions)); }
    std::unique_ptr<const Scene> finish();

  private:
    std::unique_ptr<Scene> scene_;
    std::vector<std::vector<Vec3d>> wishes_;
};

} // namespace stipple::synth
