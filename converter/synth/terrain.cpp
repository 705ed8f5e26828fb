#include "converter/synth/house.hpp"
#include "converter/synth/noise.hpp"
#include "converter/synth/scenes.hpp"
#include "converter/synth/street_objects.hpp"
#include "converter/synth/tree.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

constexpr double waterHalf = 9, plainHalf = 45, roadHalf = 3.2, roadBlend = 22, cellsPerSide = 600;

// A valley with a meandering river and a country road on one side, woods and fields on the slopes.
// Plan coordinates are scene coordinates moved by half the side.
class TerrainPlan : public GroundPlan {
  public:
    TerrainPlan(std::uint64_t seed, double side) : seed_(seed), side_(side) {}

    Vec2d place(double u, double v) const override { return {u - side_ / 2, v - side_ / 2}; }
    double height(double u, double v) const override {
        double natural = naturalHeight(u, v);
        double off = std::abs(v - roadV(u));
        if (off > roadBlend)
            return natural;
        // The road's bed is the smoothed slope along its centre, cut into and built up from the ground.
        double blend = smoothStep(roadHalf + 1.5, roadBlend, off);
        return roadHeight(u) + (natural - roadHeight(u)) * blend;
    }
    double raise(double, double) const override { return 0; }
    GroundLook look(double u, double v) const override;

    double riverV(double u) const {
        return side_ * 0.45 + 170 * fractalNoise(seed_ + 31, u / 420, 0.5, 2) + 14 * std::sin(u / 38);
    }
    double roadV(double u) const {
        return side_ * 0.45 + 150 + 190 * fractalNoise(seed_ + 32, u / 520, 3.5, 1);
    }
    double waterLevel(double u) const { return 310 - 0.006 * u; }
    // Over 0: wood; the further over, the denser.
    double wood(double u, double v) const {
        return fractalNoise(seed_ + 33, u / 210, v / 210, 3) + 0.05 -
               0.4 * smoothStep(90, 40, fromRiver(u, v));
    }
    double fromRiver(double u, double v) const { return std::abs(v - riverV(u)); }
    double side() const { return side_; }

  private:
    double naturalHeight(double u, double v) const {
        double d = fromRiver(u, v);
        double bed = -2.2 * (1 - smoothStep(waterHalf * 0.4, waterHalf + 6, d));
        double plain = 1.4 + 0.5 * fractalNoise(seed_ + 35, u / 30, v / 30, 2);
        double slope =
            smoothStep(plainHalf, 420, d) * (34 + 60 * (0.5 + fractalNoise(seed_ + 36, u / 480, v / 480, 6)));
        double rough = 0.5 * fractalNoise(seed_ + 37, u / 14, v / 14, 3) * smoothStep(20, 120, d);
        return waterLevel(u) + bed + plain + slope + rough;
    }
    double roadHeight(double u) const {
        double sum = 0;
        for (double du : {-40.0, -20.0, 0.0, 20.0, 40.0})
            sum += naturalHeight(u + du, roadV(u + du));
        return std::max(sum / 5, waterLevel(u) + 2.5);
    }

    std::uint64_t seed_;
    double side_;
};

GroundLook TerrainPlan::look(double u, double v) const {
    double off = v - roadV(u), river = fromRiver(u, v);
    auto fine = static_cast<float>(fractalNoise(seed_ + 41, u / 0.8, v / 0.8, 2));
    auto broad = static_cast<float>(fractalNoise(seed_ + 42, u / 25, v / 25, 3));
    if (std::abs(off) < roadHalf && river > waterHalf + 6) {
        bool paint = std::abs(std::abs(off) - (roadHalf - 0.25)) < 0.07 ||
                     (std::abs(off) < 0.07 && std::fmod(u, 9.0) < 4.0);
        if (paint)
            return {{0.88f, 0.88f, 0.86f}, 0.7f, classes::road};
        return {Rgb{0.31f, 0.31f, 0.32f} * (1 + 0.2f * fine), 0.17f, classes::road};
    }
    if (river < waterHalf + 3.5 + static_cast<double>(3 * broad))
        return {Rgb{0.57f, 0.54f, 0.47f} * (1 + 0.5f * fine), 0.34f, classes::ground};
    double trees = wood(u, v);
    Rgb meadow = mix({0.33f, 0.46f, 0.18f}, {0.50f, 0.49f, 0.25f}, 0.5f + broad) * (1 + 0.3f * fine);
    Rgb litter = mix({0.30f, 0.24f, 0.16f}, {0.24f, 0.28f, 0.14f}, 0.5f + broad) * (1 + 0.5f * fine);
    if (trees > 0)
        return {mix(meadow, litter, std::min(1.0f, static_cast<float>(trees * 20))), 0.32f, classes::ground};
    if (trees > -0.12 || river < plainHalf + 10)
        return {meadow, 0.48f, classes::ground};
    // Fields: strips of one crop, with rows.
    double a = 0.87 * u + 0.5 * v, b = -0.5 * u + 0.87 * v;
    std::uint64_t crop = mix64(seed_ ^ static_cast<std::uint64_t>(std::floor(a / 130)) ^
                               (static_cast<std::uint64_t>(std::floor(b / 75)) << 20)) %
                         4;
    constexpr Rgb crops[] = {
        {0.72f, 0.62f, 0.33f}, {0.42f, 0.50f, 0.19f}, {0.43f, 0.32f, 0.22f}, {0.62f, 0.60f, 0.22f}};
    float row = std::fmod(b + 1e4, 1.5) < 0.4 ? 0.82f : 1.0f;
    return {crops[crop] * (row * (1 + 0.25f * fine)), crop == 2 ? 0.25f : 0.45f, classes::ground};
}

class TerrainBuilder {
  public:
    TerrainBuilder(std::uint64_t seed, double side)
        : random_(seed ^ 0x74657272), scene_(SceneKind::terrain, seed, side) {
        auto plan = std::make_unique<TerrainPlan>(seed, side);
        plan_ = plan.get();
        double cell = std::max(2.0, side / cellsPerSide);
        auto ground = std::make_unique<Ground>(std::move(plan), std::floor(side / cell) * cell, cell);
        ground_ = ground.get();
        inner_ = std::floor(side / cell) * cell;
        scene_.setGround(std::move(ground));
    }

    std::unique_ptr<const Scene> build() {
        for (std::uint64_t i = 0; i < 5; ++i) {
            broadleaves_.push_back(scene_.addMesh(makeBroadleaf(random_.child(i))));
            conifers_.push_back(scene_.addMesh(makeConifer(random_.child(10 + i))));
            bushes_.push_back(scene_.addMesh(makeBush(random_.child(20 + i))));
        }
        addWater();
        planPowerLine();
        addFarms();
        addWoods();
        return scene_.finish();
    }

  private:
    void addWater() {
        Model water;
        auto at = [&](double u, double off) {
            Vec2d p = plan_->place(u, plan_->riverV(u) + off);
            return Vec3d{p.x, p.y, plan_->waterLevel(u)};
        };
        constexpr double reach = waterHalf + 5;
        for (double u = 0; u < inner_; u += 4) {
            double next = std::min(u + 4, inner_);
            water.quad(at(u, -reach), at(next, -reach), at(next, reach), at(u, reach), Material::water);
        }
        scene_.placeOnce(std::move(water));
    }

    // A straight line across the valley; woods keep clear of it.
    void planPowerLine() {
        Vec2d from{inner_ * 0.08, inner_ * 0.03}, to{inner_ * 0.72, inner_ * 0.97};
        Vec2d d = to - from;
        double size = std::hypot(d.x, d.y);
        lineFrom_ = from;
        lineAlong_ = d * (1 / size);
        std::uint32_t mesh = scene_.addMesh(Pylon::make());
        double yaw = std::atan2(d.y, d.x), count = std::max(1.0, std::round(size / 170));
        Vec3d before{};
        for (int i = 0; i <= static_cast<int>(count); ++i) {
            Vec2d p = from + d * (i / count);
            // Not in the river.
            double river = plan_->riverV(p.x) - p.y;
            if (std::abs(river) < 20)
                p = p - lineAlong_ * 40;
            Vec3d at = ground_->at(p.x, p.y);
            scene_.place({mesh, at, yaw, 1, {}});
            if (i > 0)
                scene_.placeOnce(makePowerSpan(before, yaw, at, yaw));
            before = at;
        }
    }
    double fromLine(double u, double v) const {
        return std::abs((u - lineFrom_.x) * lineAlong_.y - (v - lineFrom_.y) * lineAlong_.x);
    }

    void put(const std::vector<std::uint32_t>& meshes, double u, double v, double scale, Rgb colour) {
        scene_.place({meshes[random_.bits() % meshes.size()],
                      ground_->at(u, v),
                      random_.uniform(0, 6.28),
                      scale,
                      {colour}});
    }

    void addWoods() {
        constexpr double step = 5.2;
        for (double v = 3; v < inner_ - 3; v += step)
            for (double u = 3; u < inner_ - 3; u += step) {
                double tu = u + random_.uniform(-2.2, 2.2), tv = v + random_.uniform(-2.2, 2.2);
                double dice = random_.uniform(), size = random_.uniform(), shade = random_.uniform(0.85, 1.1);
                double trees = plan_->wood(tu, tv), river = plan_->fromRiver(tu, tv);
                bool clear =
                    std::abs(tv - plan_->roadV(tu)) > 9 && river > waterHalf + 5 && fromLine(tu, tv) > 16;
                for (Vec2d farm : farms_)
                    clear = clear && std::hypot(tu - farm.x, tv - farm.y) > 38;
                if (!clear)
                    continue;
                bool conifer = fractalNoise(7, tu / 160, tv / 160, 2) + 0.25 * (size - 0.5) > 0;
                Rgb colour = conifer ? Rgb{0.13f, 0.27f, 0.15f}
                                     : mix({0.24f, 0.41f, 0.13f}, {0.40f, 0.47f, 0.17f},
                                           static_cast<float>(size * dice));
                colour = colour * static_cast<float>(shade);
                if (trees > 0 && dice < 0.45 + 2 * trees)
                    put(conifer ? conifers_ : broadleaves_, tu, tv, 1.1 + 1.1 * size, colour);
                else if (trees > 0 && dice > 0.9)
                    put(bushes_, tu, tv, 0.6 + size, colour);
                else if (river < waterHalf + 16 && dice < 0.30)
                    put(dice < 0.12 ? broadleaves_ : bushes_, tu, tv, 0.7 + 0.6 * size,
                        {0.33f, 0.44f, 0.19f});
                else if (dice < 0.006)
                    put(broadleaves_, tu, tv, 0.9 + 0.7 * size, colour);
                else if (dice > 0.994)
                    put(bushes_, tu, tv, 0.8 + 0.6 * size, colour);
            }
    }

    // A farm by the road now and then: a house and a barn.
    void addFarms() {
        HouseModel house = makeHouse(randomHouse(random_.child(60)), random_.child(61));
        HouseOptions barnOptions;
        barnOptions.width = 22;
        barnOptions.depth = 11;
        barnOptions.storeys = 2;
        barnOptions.pitch = 0.8;
        barnOptions.interior = false;
        HouseModel barn = makeHouse(barnOptions, random_.child(62));
        std::uint32_t houseMesh = scene_.addMesh(std::move(house.model)),
                      barnMesh = scene_.addMesh(std::move(barn.model));
        std::uint32_t car = scene_.addMesh(makeCar(random_.child(63)));
        for (double u = 90; u < inner_ - 80; u += 310) {
            double v = plan_->roadV(u) + 24;
            if (v > inner_ - 30 || plan_->fromRiver(u, v) < 40 || fromLine(u, v) < 45)
                continue;
            for (double du : {0.0, 30.0}) {
                Vec3d at = ground_->at(u + du, v + du * 0.3);
                at.z += 0.6;
                scene_.place({du > 0 ? barnMesh : houseMesh,
                              at,
                              random_.uniform(-0.2, 0.2),
                              1,
                              {Rgb{0.88f, 0.84f, 0.76f}, Rgb{0.55f, 0.25f, 0.17f}}});
            }
            farms_.push_back({u + 15, v});
            double roadV = plan_->roadV(u + 12);
            Vec3d at = ground_->at(u + 12, roadV - 1.6);
            double yaw = std::atan2(plan_->roadV(u + 13) - plan_->roadV(u + 11), 2);
            scene_.place({car, at, yaw, 1, {Rgb{0.7f, 0.1f, 0.1f}}});
        }
    }

    Random random_;
    SceneBuilder scene_;
    TerrainPlan* plan_;
    const Ground* ground_;
    double inner_ = 0; // side of the ground, a whole number of cells
    Vec2d lineFrom_, lineAlong_;
    std::vector<Vec2d> farms_; // woods keep clear of them
    std::vector<std::uint32_t> broadleaves_, conifers_, bushes_;
};

} // namespace

std::unique_ptr<const Scene> makeTerrain(std::uint64_t seed, double sideMeters) {
    return TerrainBuilder(seed, sideMeters).build();
}

} // namespace stipple::synth
