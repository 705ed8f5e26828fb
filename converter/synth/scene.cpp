#include "converter/synth/scene.hpp"

#include "converter/synth/intersect.hpp"
#include "converter/synth/noise.hpp"
#include "converter/synth/random.hpp"
#include "converter/synth/scenes.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

Mesh::Mesh(Model model) {
    std::vector<Box<float>> boxes;
    boxes.reserve(model.primitives.size());
    for (const Primitive& primitive : model.primitives)
        boxes.push_back(boundsOf(primitive));
    std::vector<std::uint32_t> order;
    bvh = Bvh(boxes, order);
    primitives.reserve(order.size());
    for (std::uint32_t index : order)
        primitives.push_back(model.primitives[index]);
}

Vec3d Scene::Placed::toLocal(Vec3d p) const {
    Vec3d d = p - instance.position;
    double inverse = 1 / instance.scale;
    return {(cosYaw * d.x + sinYaw * d.y) * inverse, (cosYaw * d.y - sinYaw * d.x) * inverse, d.z * inverse};
}

Ray Scene::Placed::toLocal(const Ray& ray) const {
    double inverse = 1 / instance.scale;
    Vec3d d = ray.direction;
    return {
        toLocal(ray.origin),
        {(cosYaw * d.x + sinYaw * d.y) * inverse, (cosYaw * d.y - sinYaw * d.x) * inverse, d.z * inverse}};
}

Vec3d Scene::Placed::turnBack(Vec3d d) const {
    return {cosYaw * d.x - sinYaw * d.y, sinYaw * d.x + cosYaw * d.y, d.z};
}

std::size_t Scene::primitiveCount() const {
    std::size_t count = 0;
    for (const Placed& placed : placed_)
        count += meshOf(placed).primitives.size();
    return count;
}

namespace {

// Crossings met in the order of the search, kept in the order of distance.
struct Candidates {
    struct Item {
        double distance;
        std::uint32_t object, primitive;
    };
    std::array<Item, HitList::capacity> items;
    std::size_t size = 0;
    double limit;

    void add(const Item& item, bool opaque) {
        if (!(item.distance < limit))
            return;
        std::size_t at = std::min(size, items.size() - 1);
        for (; at > 0 && items[at - 1].distance > item.distance; --at)
            items[at] = items[at - 1];
        items[at] = item;
        size = std::min(size + 1, items.size());
        if (opaque) {
            size = at + 1;
            limit = item.distance;
        } else if (size == items.size()) {
            limit = std::min(limit, items[size - 1].distance);
        }
    }
};

bool isOpaque(Material material) {
    Interception how = materialInfo(material).interception;
    return how == Interception::opaque || how == Interception::water;
}

} // namespace

void Scene::castRay(const Ray& ray, double maxDistance, HitList& hits) const {
    Candidates found;
    found.limit = maxDistance;
    bvh_.traverse(ray, found.limit, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = first; k < first + count; ++k) {
            std::uint32_t object = byPlace_[k];
            const Placed& placed = placed_[object];
            const Mesh& mesh = meshOf(placed);
            Ray local = placed.toLocal(ray);
            mesh.bvh.traverse(local, found.limit, [&](std::uint32_t from, std::uint32_t size) {
                for (std::uint32_t i = from; i < from + size; ++i) {
                    const Primitive& primitive = mesh.primitives[i];
                    double distance = intersect(primitive, local, 1e-6);
                    if (distance < found.limit)
                        found.add({distance, object, i}, isOpaque(primitive.material));
                }
            });
        }
    });
    hits.size = found.size;
    for (std::size_t i = 0; i < found.size; ++i) {
        const Placed& placed = placed_[found.items[i].object];
        const Primitive& primitive = meshOf(placed).primitives[found.items[i].primitive];
        Hit& hit = hits.hits[i];
        hit.distance = found.items[i].distance;
        hit.position = ray.origin + ray.direction * hit.distance;
        hit.normal = placed.turnBack(normalAt(primitive, placed.toLocal(hit.position)));
        if (dot(hit.normal, ray.direction) > 0)
            hit.normal = hit.normal * -1.0;
        hit.material = primitive.material;
        hit.object = found.items[i].object;
        hit.primitive = found.items[i].primitive;
    }
}

double Scene::lightAlong(const Ray& ray) const {
    constexpr double leafShade = 0.4; // what one leaf or pane lets through: three make darkness
    double light = 1;
    double limit = 1e9;
    bvh_.traverse(ray, limit, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = first; k < first + count && limit > 0; ++k) {
            const Placed& placed = placed_[byPlace_[k]];
            const Mesh& mesh = meshOf(placed);
            Ray local = placed.toLocal(ray);
            mesh.bvh.traverse(local, limit, [&](std::uint32_t from, std::uint32_t size) {
                for (std::uint32_t i = from; i < from + size; ++i) {
                    const Primitive& primitive = mesh.primitives[i];
                    if (intersect(primitive, local, 1e-3) == noHit)
                        continue;
                    light *= isOpaque(primitive.material) ? 0.0 : leafShade;
                    if (light < 0.1) {
                        light = 0;
                        limit = -1;
                        return;
                    }
                }
            });
        }
    });
    return light;
}

double Scene::distanceToSurface(Vec3d point) const {
    double nearest = noHit;
    bvh_.approach(point, nearest, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t k = first; k < first + count; ++k) {
            const Placed& placed = placed_[byPlace_[k]];
            const Mesh& mesh = meshOf(placed);
            Vec3d local = placed.toLocal(point);
            double scale = placed.instance.scale, limit = nearest / scale;
            mesh.bvh.approach(local, limit, [&](std::uint32_t from, std::uint32_t size) {
                for (std::uint32_t i = from; i < from + size; ++i)
                    limit = std::min(limit, distanceTo(mesh.primitives[i], local));
            });
            nearest = std::min(nearest, limit * scale);
        }
    });
    return nearest;
}

std::optional<double> Scene::heightAt(double x, double y) const {
    if (!ground_)
        return std::nullopt;
    constexpr double above = 5000;
    Ray ray{{x, y, above}, {0, 0, -1}};
    const Mesh& mesh = meshOf(placed_[0]);
    double limit = 2 * above;
    bool found = false;
    mesh.bvh.traverse(ray, limit, [&](std::uint32_t first, std::uint32_t count) {
        for (std::uint32_t i = first; i < first + count; ++i) {
            double distance = intersect(mesh.primitives[i], ray, 0);
            if (distance < limit) {
                limit = distance;
                found = true;
            }
        }
    });
    if (!found)
        return std::nullopt;
    return above - limit;
}

namespace {

std::uint8_t vegetationClass(double heightMeters) {
    return heightMeters < 0.5 ? classes::lowVegetation
           : heightMeters < 2 ? classes::mediumVegetation
                              : classes::highVegetation;
}

bool isLeaf(Material m) {
    return m == Material::leafBroad || m == Material::leafNeedle || m == Material::leafHedge;
}

} // namespace

Look Scene::lookAt(const Hit& hit) const {
    const Placed& placed = placed_[hit.object];
    const Primitive& primitive = meshOf(placed).primitives[hit.primitive];
    const MaterialInfo& info = materialInfo(hit.material);
    Look look{info.colour, info.reflectance, info.classification};
    if (hit.material == Material::ground && ground_) {
        Vec2d uv = ground_->uvAt(primitive.tag, hit.position.x, hit.position.y);
        GroundLook ground = ground_->plan().look(uv.x, uv.y);
        return {ground.colour, ground.reflectance, ground.classification};
    }
    if (info.tint >= 0)
        look.colour = placed.instance.tints[static_cast<std::size_t>(info.tint)];
    if (isLeaf(hit.material) || hit.material == Material::bark) {
        double height = hit.position.z - placed.instance.position.z;
        look.classification = vegetationClass(height);
        if (isLeaf(hit.material)) {
            double top = static_cast<double>(meshOf(placed).bvh.bounds().max.z) * placed.instance.scale;
            look.sunlit = static_cast<float>(std::clamp(height / top, 0.0, 1.0));
        }
    }
    if (info.textureDepth > 0) {
        // One noise for floors and walls alike: the plane that the surface spreads over most.
        Vec3d q = placed.toLocal(hit.position) * (1 / static_cast<double>(info.textureScale));
        bool level = std::abs(hit.normal.z) > 0.7;
        double n = level ? fractalNoise(seed_, q.x, q.y, 2) : fractalNoise(seed_, q.x + q.y, q.z, 2);
        auto factor = static_cast<float>(1 + 2 * static_cast<double>(info.textureDepth) * n);
        look.colour = look.colour * factor;
        look.reflectance *= factor;
    }
    return look;
}

SceneBuilder::SceneBuilder(SceneKind kind, std::uint64_t seed, double sideMeters)
    : scene_(std::make_unique<Scene>()) {
    scene_->kind_ = kind;
    scene_->seed_ = seed;
    scene_->side_ = sideMeters;
}

std::uint32_t SceneBuilder::addMesh(Model model) {
    scene_->meshes_.emplace_back(std::move(model));
    return static_cast<std::uint32_t>(scene_->meshes_.size() - 1);
}

void SceneBuilder::place(const Instance& instance) {
    scene_->placed_.push_back({instance, std::cos(instance.yaw), std::sin(instance.yaw)});
}

void SceneBuilder::placeOnce(Model model, std::array<Rgb, 2> tints) {
    Instance instance;
    instance.mesh = addMesh(std::move(model));
    instance.tints = tints;
    place(instance);
}

void SceneBuilder::setGround(std::unique_ptr<const Ground> ground) {
    scene_->ground_ = std::move(ground);
    placeOnce(scene_->ground_->model());
}

std::unique_ptr<const Scene> SceneBuilder::finish() {
    std::vector<Box<float>> boxes;
    for (const auto& placed : scene_->placed_) {
        const Box<float>& local = scene_->meshOf(placed).bvh.bounds();
        Box<float> box;
        for (int corner = 0; corner < 8; ++corner) {
            Vec3d p{static_cast<double>(corner & 1 ? local.max.x : local.min.x),
                    static_cast<double>(corner & 2 ? local.max.y : local.min.y),
                    static_cast<double>(corner & 4 ? local.max.z : local.min.z)};
            box.extend(toFloat(placed.instance.position + placed.turnBack(p * placed.instance.scale)));
        }
        boxes.push_back(box);
    }
    scene_->bvh_ = Bvh(boxes, scene_->byPlace_, 1); // entering an instance costs more than a node
    for (const auto& wish : wishes_) {
        auto clear = std::find_if(wish.begin(), wish.end(),
                                  [&](Vec3d p) { return scene_->distanceToSurface(p) > 0.45; });
        if (clear != wish.end())
            scene_->stations_.push_back(*clear);
    }
    return std::move(scene_);
}

std::unique_ptr<const Scene> Scene::make(SceneKind kind, std::uint64_t seed, double sideMeters) {
    switch (kind) {
    case SceneKind::town:
        return makeTown(seed, sideMeters);
    case SceneKind::indoor:
        return makeIndoor(seed);
    case SceneKind::terrain:
        return makeTerrain(seed, sideMeters);
    }
    return nullptr;
}

} // namespace stipple::synth
