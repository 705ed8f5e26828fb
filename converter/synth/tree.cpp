#include "converter/synth/tree.hpp"

#include <algorithm>
#include <cmath>

namespace stipple::synth {

namespace {

Vec3d randomDirection(Random& random) {
    return normalized({random.normal(), random.normal(), random.normal()});
}

} // namespace

Model makeBroadleaf(Random random) {
    Model m;
    double crownBase = random.uniform(2.0, 3.2), lean = random.uniform(-0.3, 0.3);
    Vec3d top{lean, -lean, 7.5};
    m.frustum({0, 0, -1.0}, {lean * 0.3, -lean * 0.3, crownBase}, 0.24, 0.18, Material::bark);
    m.frustum({lean * 0.3, -lean * 0.3, crownBase}, top, 0.18, 0.04, Material::bark);
    // Boughs, each carrying a cloud of leaves; together they fill a rugged crown.
    int boughs = random.integer(14, 20);
    double reach = random.uniform(2.4, 3.3);
    for (int i = 0; i < boughs; ++i) {
        double t = (i + random.uniform()) / boughs, turn = 2.4 * i + random.uniform(-0.4, 0.4);
        double z = crownBase + 0.3 + t * (7.6 - crownBase),
               out = reach * (1.05 - 0.9 * t * t) * random.uniform(0.55, 1);
        Vec3d from{lean * t, -lean * t, z - 0.8 * (1 - t)};
        Vec3d to{from.x + out * std::cos(turn), from.y + out * std::sin(turn), z + 0.9};
        m.frustum(from, to, 0.07, 0.02, Material::bark);
        double size = random.uniform(0.9, 1.5);
        int leaves = static_cast<int>(42 * size * size);
        for (int k = 0; k < leaves; ++k) {
            // Towards the outside of the cloud, where light is.
            Vec3d d = randomDirection(random);
            double away = size * std::cbrt(random.uniform(0.15, 1.0));
            Vec3d normal = d + Vec3d{0, 0, 0.7} + randomDirection(random) * 0.8;
            m.disc(to + Vec3d{d.x * away, d.y * away, d.z * away * 0.75}, normal, random.uniform(0.09, 0.19),
                   Material::leafBroad);
        }
    }
    return m;
}

Model makeConifer(Random random) {
    Model m;
    m.frustum({0, 0, -1.0}, {0, 0, 10.0}, 0.20, 0.02, Material::bark);
    double base = random.uniform(0.8, 1.8), reach = random.uniform(1.6, 2.2);
    constexpr int whorls = 17;
    for (int w = 0; w < whorls; ++w) {
        double t = (w + 0.3 * random.uniform()) / whorls, z = base + t * (9.7 - base);
        double out = reach * (1 - t) * random.uniform(0.85, 1.1) + 0.12;
        int branches = 5 + static_cast<int>(4 * (1 - t));
        for (int b = 0; b < branches; ++b) {
            double turn = 2 * pi * b / branches + w * 0.9 + random.uniform(-0.2, 0.2);
            Vec3d d{std::cos(turn), std::sin(turn), 0};
            int needles = std::max(2, static_cast<int>(out * 6));
            for (int k = 1; k <= needles; ++k) {
                double s = out * (k - random.uniform(0, 0.6)) / needles;
                Vec3d at{d.x * s + random.normal() * 0.05, d.y * s + random.normal() * 0.05,
                         z - 0.28 * s + random.normal() * 0.05};
                m.disc(at, {d.x * 0.3 + random.normal() * 0.3, d.y * 0.3 + random.normal() * 0.3, 1},
                       random.uniform(0.08, 0.17), Material::leafNeedle);
            }
        }
    }
    return m;
}

Model makeBush(Random random) {
    Model m;
    for (int i = 0; i < 5; ++i)
        m.frustum({0, 0, -0.3}, {random.normal() * 0.35, random.normal() * 0.35, 1.1}, 0.03, 0.01,
                  Material::bark);
    for (int i = 0; i < 170; ++i) {
        Vec3d d = randomDirection(random);
        double away = std::cbrt(random.uniform(0.2, 1.0));
        m.disc({d.x * away * 0.8, d.y * away * 0.8, 0.75 + d.z * away * 0.75},
               d + randomDirection(random) * 0.8, random.uniform(0.05, 0.12), Material::leafHedge);
    }
    return m;
}

Model makeHedge(double size, Random random) {
    Model m;
    int leaves = static_cast<int>(size * 130);
    for (int i = 0; i < leaves; ++i) {
        // On the clipped faces more than inside.
        double x = random.uniform(-size / 2, size / 2), y = random.uniform(-0.4, 0.4),
               z = random.uniform(0.05, 1.3);
        double face = random.uniform();
        Vec3d normal = randomDirection(random) * 0.7;
        if (face < 0.3) {
            z = 1.3 + random.normal() * 0.03;
            normal.z += 1;
        } else if (face < 0.8) {
            y = (face < 0.55 ? -0.4 : 0.4) + random.normal() * 0.03;
            normal.y += 1;
        }
        m.disc({x, y, z}, normal, random.uniform(0.06, 0.12), Material::leafHedge);
    }
    for (double x = -size / 2 + 0.3; x < size / 2; x += 0.6)
        m.cylinder({x, 0, -0.5}, {x, 0, 0.9}, 0.03, Material::bark);
    return m;
}

Model makeReeds(Random random) {
    Model m;
    for (int i = 0; i < 60; ++i) {
        Vec3d at{random.normal() * 0.5, random.normal() * 0.5, random.uniform(0.1, 1.2)};
        m.disc(at, {random.normal(), random.normal(), 0.3}, random.uniform(0.04, 0.09), Material::leafHedge);
    }
    return m;
}

} // namespace stipple::synth
