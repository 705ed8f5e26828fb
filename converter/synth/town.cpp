#include "converter/synth/furniture.hpp"
#include "converter/synth/house.hpp"
#include "converter/synth/noise.hpp"
#include "converter/synth/scenes.hpp"
#include "converter/synth/street_objects.hpp"
#include "converter/synth/town_plan.hpp"
#include "converter/synth/tree.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

constexpr Rgb wallColours[] = {{0.93f, 0.90f, 0.84f}, {0.90f, 0.82f, 0.64f}, {0.84f, 0.72f, 0.60f},
                               {0.76f, 0.79f, 0.78f}, {0.88f, 0.76f, 0.70f}, {0.70f, 0.74f, 0.66f},
                               {0.95f, 0.95f, 0.95f}, {0.80f, 0.66f, 0.42f}};
constexpr Rgb roofColours[] = {{0.62f, 0.27f, 0.17f}, {0.52f, 0.22f, 0.16f}, {0.68f, 0.36f, 0.23f},
                               {0.32f, 0.31f, 0.32f}, {0.40f, 0.28f, 0.22f}, {0.26f, 0.27f, 0.31f}};
constexpr Rgb carColours[] = {{0.80f, 0.81f, 0.82f}, {0.12f, 0.12f, 0.13f}, {0.45f, 0.47f, 0.49f},
                              {0.55f, 0.08f, 0.08f}, {0.10f, 0.18f, 0.42f}, {0.93f, 0.93f, 0.92f},
                              {0.20f, 0.30f, 0.22f}, {0.75f, 0.62f, 0.18f}};
constexpr Rgb leafColours[] = {{0.25f, 0.42f, 0.13f},
                               {0.31f, 0.47f, 0.16f},
                               {0.20f, 0.36f, 0.14f},
                               {0.38f, 0.48f, 0.18f},
                               {0.29f, 0.38f, 0.12f}};

template <std::size_t N>
Rgb pick(const Rgb (&colours)[N], Random& random) {
    return colours[random.bits() % N] * static_cast<float>(random.uniform(0.92, 1.05));
}

// Builds the town block by block; `random` is drawn from in a fixed order.
class TownBuilder {
  public:
    TownBuilder(std::uint64_t seed, double side)
        : random_(seed ^ 0x746f776e), scene_(SceneKind::town, seed, side) {
        auto plan = std::make_unique<TownPlan>(seed, side);
        plan_ = plan.get();
        auto ground = std::make_unique<Ground>(std::move(plan), side, TownPlan::cell);
        ground_ = ground.get();
        scene_.setGround(std::move(ground));
    }

    std::unique_ptr<const Scene> build() {
        makeModels();
        addWater();
        addBridge();
        for (Block& block : plan_->blocks())
            fill(block);
        furnishStreets();
        addOutskirts();
        addPowerLine();
        placeStations();
        return scene_.finish();
    }

  private:
    struct Prototype {
        std::uint32_t mesh;
        double width, depth;
        Vec3d inside;
    };

    void makeModels();
    void addWater();
    void addBridge();
    void fill(Block& block);
    void fillHouses(Block& block, bool flats);
    void addLot(Block& block, double u0, double u1, bool north);
    void fillPark(Block& block);
    void fillChurch(Block& block);
    void fillTowers(Block& block);
    void fillMarket(Block& block);
    void furnishStreets();
    void addOutskirts();
    void addPowerLine();
    void placeStations();

    void put(std::uint32_t mesh, double u, double v, double turn, double scale, std::array<Rgb, 2> tints,
             double lift = 0) {
        Vec3d at = ground_->at(u, v);
        at.z += lift;
        scene_.place({mesh, at, ground_->yawAt(u, v) + turn, scale, tints});
    }
    void putTree(double u, double v, double scale) {
        bool conifer = random_.chance(0.2);
        const auto& kind = conifer ? conifers_ : broadleaves_;
        Rgb colour = conifer ? Rgb{0.14f, 0.28f, 0.15f} : pick(leafColours, random_);
        put(kind[random_.bits() % kind.size()], u, v, random_.uniform(0, 6.28), scale, {colour});
    }
    void putCar(double u, double v, double turn) {
        put(cars_[random_.bits() % cars_.size()], u, v, turn + (random_.chance(0.5) ? pi : 0), 1,
            {pick(carColours, random_)});
    }
    // On the highest corner of its footprint, so that no ground comes through the floor.
    void putBuilding(const Prototype& p, double u, double v, double turn, double lift = 0.3) {
        double top = -1e9;
        for (double s : {-0.5, 0.5})
            for (double t : {-0.5, 0.5}) {
                bool sideways = std::abs(std::sin(turn)) > 0.7;
                top = std::max(top, ground_
                                        ->at(u + s * (sideways ? p.depth : p.width),
                                             v + t * (sideways ? p.width : p.depth))
                                        .z);
            }
        Vec3d at = ground_->at(u, v);
        at.z = top + lift;
        double yaw = ground_->yawAt(u, v) + turn;
        scene_.place({p.mesh, at, yaw, 1, {pick(wallColours, random_), pick(roofColours, random_)}});
        if (p.inside.z > 0)
            rooms_.push_back({at.x + std::cos(yaw) * p.inside.x - std::sin(yaw) * p.inside.y,
                              at.y + std::sin(yaw) * p.inside.x + std::cos(yaw) * p.inside.y,
                              at.z + p.inside.z});
    }

    Random random_;
    SceneBuilder scene_;
    TownPlan* plan_;
    const Ground* ground_;
    std::vector<Prototype> houses_, flats_, towers_;
    std::vector<std::uint32_t> broadleaves_, conifers_, bushes_, cars_;
    std::uint32_t hedge_ = 0, lamp_ = 0, bench_ = 0, sign_ = 0, shed_ = 0, reeds_ = 0, pylon_ = 0, pole_ = 0;
    std::vector<Vec3d> rooms_;
};

void TownBuilder::makeModels() {
    for (std::uint64_t i = 0; i < 18; ++i) {
        HouseModel house = makeHouse(randomHouse(random_.child(100 + i)), random_.child(200 + i));
        houses_.push_back(
            {scene_.addMesh(std::move(house.model)), house.width, house.depth, house.livingRoom});
    }
    for (std::uint64_t i = 0; i < 5; ++i) {
        HouseOptions o;
        o.width = 18 + 2.0 * static_cast<double>(i % 3);
        o.depth = 11;
        o.storeys = 3 + static_cast<int>(i % 2);
        o.roof = i == 4 ? RoofKind::flat : i % 2 == 0 ? RoofKind::gable : RoofKind::hip;
        o.pitch = 0.7;
        o.balconies = true;
        if (i == 1)
            o.wall = Material::brick;
        HouseModel house = makeHouse(o, random_.child(300 + i));
        flats_.push_back({scene_.addMesh(std::move(house.model)), house.width, house.depth, {}});
    }
    towers_.push_back({scene_.addMesh(makeTowerBlock(12, 20, 14)), 20, 14, {}});
    towers_.push_back({scene_.addMesh(makeTowerBlock(9, 24, 13)), 24, 13, {}});
    for (std::uint64_t i = 0; i < 6; ++i) {
        broadleaves_.push_back(scene_.addMesh(makeBroadleaf(random_.child(400 + i))));
        cars_.push_back(scene_.addMesh(makeCar(random_.child(600 + i))));
    }
    for (std::uint64_t i = 0; i < 3; ++i) {
        conifers_.push_back(scene_.addMesh(makeConifer(random_.child(500 + i))));
        bushes_.push_back(scene_.addMesh(makeBush(random_.child(700 + i))));
    }
    hedge_ = scene_.addMesh(makeHedge(3, random_.child(800)));
    reeds_ = scene_.addMesh(makeReeds(random_.child(801)));
    lamp_ = scene_.addMesh(makeLampPost());
    bench_ = scene_.addMesh(makeBench());
    sign_ = scene_.addMesh(makeTrafficSign());
    shed_ = scene_.addMesh(makeShed());
    pylon_ = scene_.addMesh(Pylon::make());
    pole_ = scene_.addMesh(WoodPole::make());
}

void TownBuilder::addWater() {
    Model water;
    constexpr double step = 10;
    auto at = [&](double u, double v) {
        Vec2d p = plan_->place(u, v);
        return Vec3d{p.x, p.y, plan_->waterLevel(u)};
    };
    double v0 = plan_->river() - TownPlan::waterHalf, v1 = plan_->river() + TownPlan::waterHalf;
    for (double u = 0; u < plan_->side() - 1e-9; u += step) {
        double next = std::min(u + step, plan_->side());
        water.quad(at(u, v0), at(next, v0), at(next, v1), at(u, v1), Material::water);
    }
    scene_.placeOnce(std::move(water));
    for (double u = 4; u < plan_->side() - 4; u += random_.uniform(2, 9))
        for (double side : {-1.0, 1.0})
            if (random_.chance(0.5) && std::abs(u - plan_->mainStreet()) > 12)
                put(reeds_, u, plan_->river() + side * random_.uniform(15.5, 17.5), 0,
                    random_.uniform(0.7, 1.3), {pick(leafColours, random_)});
}

void TownBuilder::addBridge() {
    double u = plan_->mainStreet(), reach = TownPlan::riverHalf + 0.5;
    Vec3d a = ground_->at(u, plan_->river() - reach), b = ground_->at(u, plan_->river() + reach);
    Model bridge = makeBridge(length(b - a) + 1, 12, 9);
    Instance instance;
    instance.mesh = scene_.addMesh(std::move(bridge));
    instance.position = (a + b) * 0.5;
    instance.position.z = std::max(a.z, b.z) + 0.03;
    instance.yaw = std::atan2(b.y - a.y, b.x - a.x) - pi / 2;
    scene_.place(instance);
}

void TownBuilder::fill(Block& block) {
    switch (block.use) {
    case Block::Use::houses:
        return fillHouses(block, false);
    case Block::Use::flats:
        return fillHouses(block, true);
    case Block::Use::church:
        return fillChurch(block);
    case Block::Use::park:
        return fillPark(block);
    case Block::Use::towers:
        return fillTowers(block);
    case Block::Use::market:
        return fillMarket(block);
    }
}

void TownBuilder::fillHouses(Block& block, bool flats) {
    const Rect& a = block.area;
    for (bool north : {false, true}) {
        if (!flats) {
            double count = std::floor((a.u1 - a.u0) / random_.uniform(15.5, 18.5)),
                   lot = (a.u1 - a.u0) / count;
            for (int i = 0; i < static_cast<int>(count); ++i)
                addLot(block, a.u0 + i * lot, a.u0 + (i + 1) * lot, north);
            continue;
        }
        for (double u = a.u0 + 2; u < a.u1 - 20;) {
            const Prototype& p = flats_[random_.bits() % flats_.size()];
            putBuilding(p, u + p.width / 2, north ? a.v1 - 3 - p.depth / 2 : a.v0 + 3 + p.depth / 2,
                        north ? pi : 0);
            block.paved.push_back({u + p.width / 2 - 1.5, north ? a.v1 - 4 : a.v0, u + p.width / 2 + 1.5,
                                   north ? a.v1 : a.v0 + 4});
            u += p.width + random_.uniform(1.5, 6);
        }
    }
    if (flats) {
        double middle = (a.v0 + a.v1) / 2;
        block.paved.push_back({a.u0, middle - 3, a.u1, middle + 3});
        for (double u = a.u0 + 5; u < a.u1 - 5; u += 2.8)
            if (random_.chance(0.45))
                putCar(u, middle + 1, pi / 2);
        for (double u = a.u0 + 4; u < a.u1 - 4; u += random_.uniform(7, 14))
            putTree(u, middle + (random_.chance(0.5) ? -5 : 5.5), random_.uniform(0.5, 0.8));
    }
}

// One family house with drive, hedges, garden, perhaps a shed. `north`: it faces the street at larger v.
void TownBuilder::addLot(Block& block, double u0, double u1, bool north) {
    const Rect& a = block.area;
    auto v = [&](double fromStreet) { return north ? a.v1 - fromStreet : a.v0 + fromStreet; };
    auto pave = [&](double left, double right, double from, double to) {
        block.paved.push_back({left, std::min(v(from), v(to)), right, std::max(v(from), v(to))});
    };
    double middle = (a.v1 - a.v0) / 2;
    const Prototype& p = houses_[random_.bits() % houses_.size()];
    double setback = random_.uniform(5.5, 7), width = std::min(p.width, u1 - u0 - 2);
    double house = u1 - 1.2 - width / 2;
    if (random_.chance(0.06)) { // an empty lot
        for (int i = 0; i < 4; ++i)
            putTree(random_.uniform(u0 + 3, u1 - 3), v(random_.uniform(5, middle)), random_.uniform(0.5, 1));
        return;
    }
    putBuilding(p, house, v(setback + p.depth / 2), north ? pi : 0, 0.25);
    double drive = u0 + 0.4;
    pave(drive, drive + 2.6, 0, setback + 6);
    pave(house - 1, house + 1, 0, setback);
    pave(house - 3, house + 3, setback + p.depth, setback + p.depth + 3);
    if (random_.chance(0.6))
        putCar(drive + 1.3, v(random_.uniform(3, setback + 3)), pi / 2);
    double height = random_.uniform(0.8, 1.2);
    Rgb green = pick(leafColours, random_) * 0.85f;
    if (random_.chance(0.7))
        for (double u = drive + 4.4; u < u1 - 0.8; u += 3)
            if (std::abs(u - house) > 2.6)
                put(hedge_, u, v(0.7), 0, height, {green});
    if (random_.chance(0.7))
        for (double d = setback + 3; d < middle - 1; d += 3)
            put(hedge_, u1, v(d), pi / 2, height, {green});
    double gardenFrom = setback + p.depth + 3;
    for (int i = random_.integer(0, 3); i > 0 && gardenFrom < middle - 2; --i)
        putTree(random_.uniform(u0 + 2, u1 - 2), v(random_.uniform(gardenFrom, middle - 0.5)),
                random_.uniform(0.4, 0.95));
    for (int i = random_.integer(0, 4); i > 0; --i)
        put(bushes_[random_.bits() % bushes_.size()], random_.uniform(u0 + 3.2, u1),
            v(random_.uniform(1.5, 4)), 0, random_.uniform(0.5, 1.1), {pick(leafColours, random_)});
    if (random_.chance(0.4) && gardenFrom < middle - 3)
        put(shed_, u0 + 2.2, v(middle - 1.8), north ? pi : 0, 1, {});
}

void TownBuilder::fillPark(Block& block) {
    const Rect& a = block.area;
    double cu = (a.u0 + a.u1) / 2, cv = (a.v0 + a.v1) / 2;
    block.paved.push_back({cu - 1.2, a.v0, cu + 1.2, a.v1});
    block.paved.push_back({a.u0, cv - 1.2, a.u1, cv + 1.2});
    block.paved.push_back({cu - 5, cv - 5, cu + 5, cv + 5});
    for (double u = a.u0 + 4; u < a.u1 - 3; u += 7)
        for (double v = a.v0 + 4; v < a.v1 - 3; v += 7) {
            double tu = u + random_.uniform(-2.5, 2.5), tv = v + random_.uniform(-2.5, 2.5);
            bool clear = std::abs(tu - cu) > 3 && std::abs(tv - cv) > 3 && std::hypot(tu - cu, tv - cv) > 9;
            if (clear && random_.chance(0.6))
                putTree(tu, tv, random_.uniform(0.8, 1.6));
            else if (clear && random_.chance(0.4))
                put(bushes_[random_.bits() % bushes_.size()], tu, tv, 0, random_.uniform(0.7, 1.4),
                    {pick(leafColours, random_)});
        }
    for (double d = 6; d < (a.u1 - a.u0) / 2 - 3; d += 8)
        for (double s : {-1.0, 1.0})
            put(bench_, cu + s * d, cv + s * 1.8, s > 0 ? 0 : pi, 1, {});
    put(lamp_, cu + 4, cv + 4, 0, 0.7, {});
    scene_.station({ground_->at(cu, cv) + Vec3d{0, 0, 1.7}});
}

void TownBuilder::fillChurch(Block& block) {
    const Rect& a = block.area;
    double cu = (a.u0 + a.u1) / 2, cv = (a.v0 + a.v1) / 2;
    block.paved.push_back({a.u0 + 3, a.v0 + 2, a.u1 - 3, a.v1 - 2});
    Prototype church{scene_.addMesh(makeChurch()), 14, 34, {0, 4, 1.7}};
    putBuilding(church, cu + 3, cv, -pi / 2, 0.35);
    for (double u = a.u0 + 5; u < a.u1 - 4; u += 8)
        for (double v : {a.v0 + 4, a.v1 - 4})
            putTree(u, v, random_.uniform(0.7, 0.9));
    for (double v = a.v0 + 9; v < a.v1 - 8; v += 7)
        put(bench_, a.u0 + 6, v, pi / 2, 1, {});
}

void TownBuilder::fillTowers(Block& block) {
    const Rect& a = block.area;
    double cv = (a.v0 + a.v1) / 2;
    putBuilding(towers_[0], a.u0 + 16, cv, 0);
    if (a.u1 - a.u0 > 64)
        putBuilding(towers_[1], a.u1 - 17, cv + 4, 0);
    double cu = (a.u0 + a.u1) / 2;
    Rect lot{cu - 7.8, a.v0, cu + 7.8, a.v0 + 21};
    block.paved.push_back(lot);
    for (double u = lot.u0 + 1.3; u < lot.u1; u += 2.6)
        for (double v : {lot.v0 + 2.5, lot.v0 + 18.5})
            if (random_.chance(0.6))
                putCar(u, v, pi / 2);
    for (int i = 0; i < 16; ++i) {
        double u = random_.uniform(a.u0 + 3, a.u1 - 3), v = random_.chance(0.5) ? a.v0 + 4 : a.v1 - 4;
        if (!lot.contains(u, v))
            putTree(u, v, random_.uniform(0.7, 1.3));
    }
}

void TownBuilder::fillMarket(Block& block) {
    const Rect& a = block.area;
    double width = std::min(44.0, a.u1 - a.u0 - 8), depth = 17;
    Prototype hall{scene_.addMesh(makeHall(width, depth, 5.2)), width, depth, {}};
    double cu = (a.u0 + a.u1) / 2;
    putBuilding(hall, cu, a.v1 - 2 - depth / 2, 0, 0.1);
    Rect lot{a.u0 + 1, a.v0, a.u1 - 1, a.v1 - 3 - depth};
    block.paved.push_back(lot);
    for (double v = lot.v0 + 2.5; v < lot.v1; v += 16)
        for (double u = lot.u0 + 1.3; u < lot.u1 - 1; u += 2.6)
            if (random_.chance(0.5))
                putCar(u, v, pi / 2);
    for (double u = lot.u0 + 6; u < lot.u1; u += 18)
        put(lamp_, u, lot.v0 + 7, 0, 1, {});
}

void TownBuilder::furnishStreets() {
    double first = plan_->across().front().centre, last = plan_->across().back().centre;
    auto nearJunction = [&](const std::vector<Street>& streets, double x, double reach) {
        return std::any_of(streets.begin(), streets.end(),
                           [&](const Street& s) { return std::abs(s.centre - x) < s.halfWidth + reach; });
    };
    int number = 0;
    for (const Street& street : plan_->along()) {
        for (double u = first + 14; u < last; u += 7)
            for (double side : {-1.0, 1.0})
                if (random_.chance(0.33) && !nearJunction(plan_->across(), u, 9))
                    putCar(u, street.centre + side * 2.95, 0);
        for (double u = first + 16; u < last; u += 32)
            if (!nearJunction(plan_->across(), u, 2)) {
                double side = ++number % 2 == 0 ? 1 : -1;
                put(lamp_, u, street.centre + side * 4.6, side > 0 ? 0 : pi, 1, {});
            }
        for (const Street& crossing : plan_->across())
            put(sign_, crossing.centre - crossing.halfWidth - 0.7, street.centre - 4.7, pi / 2, 1, {});
    }
    double low = plan_->along().front().centre, high = plan_->along().back().centre;
    for (double v = low + 12; v < high; v += 11)
        for (double side : {-1.0, 1.0})
            if (!nearJunction(plan_->along(), v, 5) && std::abs(v - plan_->river()) > TownPlan::riverHalf + 6)
                putTree(plan_->mainStreet() + side * 7.2, v, random_.uniform(0.55, 0.75));
    // Telephone poles along the first street.
    Vec3d before{};
    double v = plan_->along().front().centre - 5.4;
    for (double u = first + 3; u < last; u += 34) {
        Vec3d at = ground_->at(u, v);
        put(pole_, u, v, 0, 1, {});
        if (u > first + 4)
            scene_.placeOnce(makePoleSpan(before, at));
        before = at;
    }
}

// Meadow trees around the built area.
void TownBuilder::addOutskirts() {
    double side = plan_->side();
    for (double u = 3; u < side - 3; u += 6)
        for (double v : {random_.uniform(2, 10), side - TownPlan::powerLineMargin - random_.uniform(0, 5)})
            if (random_.chance(0.35) && std::abs(v - plan_->river()) > TownPlan::riverHalf &&
                v > plan_->along().back().centre + 8 - (v < 20 ? 1e9 : 0))
                putTree(u, v, random_.uniform(0.6, 1.4));
    for (double v = 14; v < side - TownPlan::powerLineMargin; v += 7)
        for (double u : {random_.uniform(3, 10), side - random_.uniform(3, 8)})
            if (random_.chance(0.35) && std::abs(v - plan_->river()) > TownPlan::riverHalf &&
                (u < 12 || u > plan_->across().back().centre + 8))
                putTree(u, v, random_.uniform(0.6, 1.4));
}

void TownBuilder::addPowerLine() {
    double v = plan_->side() - 12,
           step = (plan_->side() - 20) / std::max(1.0, std::floor((plan_->side() - 20) / 110));
    Vec3d before{};
    double yawBefore = 0;
    for (double u = 10; u < plan_->side(); u += step) {
        Vec3d at = ground_->at(u, v);
        double yaw = ground_->yawAt(u, v);
        scene_.place({pylon_, at, yaw, 1, {}});
        if (u > 11)
            scene_.placeOnce(makePowerSpan(before, yawBefore, at, yaw));
        before = at;
        yawBefore = yaw;
    }
}

void TownBuilder::placeStations() {
    for (std::size_t j = 0; j < plan_->along().size(); ++j)
        for (std::size_t i = 0; i < plan_->across().size(); ++i)
            if ((i + j) % 2 == 0) {
                const Street &a = plan_->across()[i], &b = plan_->along()[j];
                scene_.station({ground_->at(a.centre + 1.2, b.centre + 0.8) + Vec3d{0, 0, 1.75}});
            }
    // One house in twelve is scanned inside too.
    for (std::size_t i = 0; i < rooms_.size(); i += 12)
        scene_.station({rooms_[i], rooms_[i] + Vec3d{0.5, -0.4, 0}});
}

} // namespace

std::unique_ptr<const Scene> makeTown(std::uint64_t seed, double sideMeters) {
    return TownBuilder(seed, sideMeters).build();
}

} // namespace stipple::synth
