#include "converter/synth/street_objects.hpp"

#include <cmath>

namespace stipple::synth {

Model makeLampPost() {
    Model m;
    m.frustum({0, 0, -0.5}, {0, 0, 6.8}, 0.09, 0.05, Material::lampPost);
    m.cylinder({0, 0, 6.8}, {0, -1.3, 7.0}, 0.035, Material::lampPost);
    m.box({-0.14, -1.75, 6.92}, {0.14, -1.2, 7.05}, Material::lampPost);
    m.disc({0, 0, 0.25}, {0, 0, 1}, 0.16, Material::lampPost);
    m.cylinder({0, 0, 0}, {0, 0, 0.25}, 0.16, Material::lampPost);
    return m;
}

Model makeCar(Random random) {
    Model m;
    double half = random.uniform(1.95, 2.35), wide = random.uniform(0.84, 0.92),
           roof = random.uniform(1.40, 1.75);
    bool van = roof > 1.62;
    constexpr double belt = 0.92, sill = 0.28;
    // The side profile, front (+x) to back, is drawn out to the width; above the belt it leans in.
    struct Corner {
        double x, z, y;
    };
    double in = wide - 0.14;
    double roofBack = van ? -half + 0.15 : -half + 0.95;
    Corner profile[] = {{half, sill, wide},
                        {half + 0.03, 0.62, wide},
                        {half - 0.15, 0.78, wide},
                        {half - 1.05, belt, wide},
                        {half - 1.75, roof, in},
                        {roofBack, roof, in},
                        {van ? -half + 0.02 : -half + 0.35, belt + 0.08, wide},
                        {-half, 0.85, wide},
                        {-half, sill, wide}};
    constexpr int count = 9;
    for (int i = 0; i < count; ++i) {
        const Corner &p = profile[i], &q = profile[(i + 1) % count];
        Material material = i == 3 || i == 5 ? Material::carGlass : Material::carPaint;
        m.quad({p.x, -p.y, p.z}, {q.x, -q.y, q.z}, {q.x, q.y, q.z}, {p.x, p.y, p.z}, material);
    }
    for (double s : {-1.0, 1.0}) {
        auto at = [&](int i) { return Vec3d{profile[i].x, s * profile[i].y, profile[i].z}; };
        // Body below the belt, glass above.
        m.quad(at(0), at(1), at(2), at(3), Material::carPaint);
        m.quad(at(0), at(3), at(6), at(8), Material::carPaint);
        m.triangle(at(6), at(7), at(8), Material::carPaint);
        m.quad(at(3), at(4), at(5), at(6), Material::carGlass);
        for (double x : {half - 0.75, -half + 0.75}) {
            m.cylinder({x, s * (wide - 0.18), 0.31}, {x, s * (wide + 0.01), 0.31}, 0.31, Material::rubber);
            m.disc({x, s * (wide + 0.01), 0.31}, {0, 1, 0}, 0.31, Material::rubber);
            m.disc({x, s * (wide + 0.015), 0.31}, {0, 1, 0}, 0.19, Material::railing);
        }
        m.box({half - 1.5, s * (wide + 0.08) - 0.08, belt},
              {half - 1.35, s * (wide + 0.08) + 0.08, belt + 0.14}, Material::carPaint);
    }
    return m;
}

Model makeBench() {
    Model m;
    for (double y : {-0.18, -0.02, 0.14})
        m.box({-0.8, y - 0.06, 0.42}, {0.8, y + 0.06, 0.46}, Material::wood);
    for (double z : {0.60, 0.78})
        m.box({-0.8, 0.24, z}, {0.8, 0.28, z + 0.12}, Material::wood);
    for (double x : {-0.6, 0.6}) {
        m.box({x - 0.04, -0.2, 0}, {x + 0.04, 0.2, 0.42}, Material::railing);
        m.box({x - 0.04, 0.20, 0.42}, {x + 0.04, 0.24, 0.9}, Material::railing);
    }
    return m;
}

Model makeTrafficSign() {
    Model m;
    m.cylinder({0, 0, -0.3}, {0, 0, 2.6}, 0.03, Material::lampPost);
    m.disc({0, -0.04, 2.4}, {0, 1, 0}, 0.30, Material::signFace);
    return m;
}

namespace {

constexpr double armHeights[3] = {19.5, 23.5, 27.0};
constexpr double armReach[3] = {5.2, 6.8, 4.6};
constexpr double insulatorDrop = 1.8;

// Half the width of the tower's square section at height z.
double towerHalf(double z) {
    return z < 18 ? 2.6 - z * (1.9 / 18) : 0.7 - (z - 18) * (0.55 / 13);
}

} // namespace

Vec3d Pylon::holder(int wire) {
    if (wire == 6)
        return {0, 0, height};
    double side = wire % 2 == 0 ? -1 : 1;
    return {0, side * armReach[wire / 2], armHeights[wire / 2] - insulatorDrop};
}

Model Pylon::make() {
    Model m;
    auto bar = [&](Vec3d a, Vec3d b, double radius) { m.cylinder(a, b, radius, Material::lattice); };
    double levels[] = {0, 4, 8, 12, 15.5, 18, 20, 22, 24, 26, 28, height};
    auto corner = [&](double z, int i) {
        constexpr double sx[] = {-1, 1, 1, -1}, sy[] = {-1, -1, 1, 1};
        return Vec3d{sx[i] * towerHalf(z), sy[i] * towerHalf(z), z};
    };
    for (std::size_t k = 0; k + 1 < std::size(levels); ++k)
        for (int i = 0; i < 4; ++i) {
            int j = (i + 1) % 4;
            double z0 = levels[k], z1 = levels[k + 1];
            bar(corner(z0, i), corner(z1, i), 0.10);
            bar(corner(z0, i), corner(z1, j), 0.045);
            bar(corner(z0, j), corner(z1, i), 0.045);
            bar(corner(z1, i), corner(z1, j), 0.045);
        }
    for (int i = 0; i < 4; ++i)
        m.standingBox({corner(0, i).x, corner(0, i).y, -2}, {0.9, 0.9, 2.3}, 0, Material::footing);
    for (int arm = 0; arm < 3; ++arm)
        for (double side : {-1.0, 1.0}) {
            double z = armHeights[arm], half = towerHalf(z), reach = armReach[arm];
            Vec3d tip{0, side * reach, z};
            for (double x : {-half, half}) {
                bar({x, side * half, z}, tip, 0.06);
                bar({x, side * half, z + 1.6}, tip, 0.05);
                for (double t : {0.3, 0.6})
                    bar(Vec3d{x, side * half, z} + (tip - Vec3d{x, side * half, z}) * t,
                        Vec3d{x, side * half, z + 1.6} + (tip - Vec3d{x, side * half, z + 1.6}) * t, 0.03);
            }
            for (int disc = 0; disc < 9; ++disc)
                m.disc({0, side * reach, z - 0.15 - 0.18 * disc}, {0, 0, 1}, 0.13, Material::insulator);
            m.cylinder({0, side * reach, z - insulatorDrop}, {0, side * reach, z}, 0.04, Material::insulator);
        }
    return m;
}

Model makePowerSpan(Vec3d a, double yawA, Vec3d b, double yawB) {
    Model m;
    auto held = [](Vec3d at, double yaw, Vec3d h) {
        return Vec3d{at.x + std::cos(yaw) * h.x - std::sin(yaw) * h.y,
                     at.y + std::sin(yaw) * h.x + std::cos(yaw) * h.y, at.z + h.z};
    };
    double span = length(b - a);
    // Sag of a conductor at everyday tension: w L² / 8 H, about 1/2800 per metre of span squared.
    double sag = span * span / 2800;
    for (int wire = 0; wire < 7; ++wire) {
        bool guard = wire == 6;
        m.wire(held(a, yawA, Pylon::holder(wire)), held(b, yawB, Pylon::holder(wire)),
               guard ? sag * 0.7 : sag, 40, guard ? 0.02 : 0.035,
               guard ? Material::guardWire : Material::conductor);
    }
    return m;
}

Model WoodPole::make() {
    Model m;
    m.frustum({0, 0, -1}, {0, 0, height}, 0.15, 0.11, Material::woodPole);
    m.box({-0.06, -0.9, height - 0.5}, {0.06, 0.9, height - 0.38}, Material::woodPole);
    for (double y : {-0.8, 0.0, 0.8})
        m.cylinder({0, y, height - 0.38}, {0, y, height - 0.1}, 0.05, Material::insulator);
    return m;
}

Model makePoleSpan(Vec3d a, Vec3d b) {
    Model m;
    Vec3d d = normalized(b - a);
    double span = length(b - a);
    for (double y : {-0.8, 0.0, 0.8}) {
        Vec3d side{-d.y * y, d.x * y, WoodPole::height - 0.1};
        m.wire(a + side, b + side, span * span / 2000, 16, 0.02, Material::conductor);
    }
    return m;
}

Model makeBridge(double size, double width, double depth) {
    Model m;
    double y = size / 2, x = width / 2;
    // The roadway in slabs, so that its texture is bridge deck; parapets beside it.
    m.box({-x, -y, -0.9}, {x, y, 0}, Material::bridgeDeck);
    for (double s : {-1.0, 1.0}) {
        m.box({s * x - 0.9, -y, 0}, {s * x + 0.9, y, 0.16}, Material::bridgeConcrete);
        m.box({s * (x + 0.78) - 0.12, -y, -0.9}, {s * (x + 0.78) + 0.12, y, 0.45}, Material::bridgeConcrete);
        for (double p = -y; p <= y; p += 2)
            m.cylinder({s * (x + 0.78), p, 0.45}, {s * (x + 0.78), p, 1.15}, 0.03, Material::railing);
        for (double z : {0.8, 1.15})
            m.cylinder({s * (x + 0.78), -y, z}, {s * (x + 0.78), y, z}, 0.03, Material::railing);
    }
    for (double p : {-y * 0.33, y * 0.33}) {
        m.box({-x + 0.6, p - 0.6, -depth}, {x - 0.6, p + 0.6, -0.9}, Material::bridgeConcrete);
        for (double s : {-1.0, 1.0})
            m.frustum({s * (x - 0.6), p, -depth}, {s * (x - 0.6), p, -0.9}, 0.6, 0.6,
                      Material::bridgeConcrete);
    }
    for (double s : {-1.0, 1.0})
        m.box({-x - 0.9, s * y - 0.8, -depth}, {x + 0.9, s * y + 0.8, -0.9}, Material::bridgeConcrete);
    // Centre line, a finger above the deck.
    for (double p = -y + 1; p + 2 < y; p += 5)
        m.quad({-0.07, p, 0.004}, {0.07, p, 0.004}, {0.07, p + 2, 0.004}, {-0.07, p + 2, 0.004},
               Material::marking);
    return m;
}

} // namespace stipple::synth
