#include "converter/synth/furniture.hpp"

#include <cmath>

namespace stipple::synth {

namespace {

void legs(Model& m, double x, double y, double height, double radius, Material material) {
    for (double sx : {-1.0, 1.0})
        for (double sy : {-1.0, 1.0})
            m.cylinder({sx * x, sy * y, 0}, {sx * x, sy * y, height}, radius, material);
}

} // namespace

Model makeTable(double width, double depth, double height) {
    Model m;
    m.box({-width / 2, -depth / 2, height - 0.04}, {width / 2, depth / 2, height}, Material::wood);
    legs(m, width / 2 - 0.06, depth / 2 - 0.06, height - 0.04, 0.03, Material::wood);
    return m;
}

Model makeChair() {
    Model m;
    m.box({-0.22, -0.22, 0.43}, {0.22, 0.22, 0.47}, Material::fabric);
    legs(m, 0.19, 0.19, 0.43, 0.015, Material::wood);
    m.box({-0.21, 0.19, 0.60}, {0.21, 0.22, 0.92}, Material::fabric);
    for (double x : {-0.18, 0.18})
        m.cylinder({x, 0.205, 0.47}, {x, 0.205, 0.60}, 0.012, Material::wood);
    return m;
}

Model makeDesk() {
    Model m;
    m.box({-0.80, -0.40, 0.70}, {0.80, 0.40, 0.73}, Material::wood);
    m.box({-0.78, -0.38, 0}, {-0.38, 0.38, 0.66}, Material::plastic);
    m.cylinder({0.74, -0.34, 0}, {0.74, -0.34, 0.70}, 0.025, Material::plastic);
    m.cylinder({0.74, 0.34, 0}, {0.74, 0.34, 0.70}, 0.025, Material::plastic);
    m.box({-0.10, 0.16, 0.73}, {0.14, 0.32, 0.745}, Material::plastic);
    m.box({-0.01, 0.24, 0.745}, {0.05, 0.27, 0.88}, Material::plastic);
    m.box({-0.28, 0.20, 0.84}, {0.32, 0.235, 1.19}, Material::screen);
    m.box({-0.20, -0.25, 0.73}, {0.25, -0.11, 0.75}, Material::screen);
    return m;
}

Model makeSofa() {
    Model m;
    m.box({-1.0, -0.42, 0.08}, {1.0, 0.42, 0.42}, Material::fabric);
    m.box({-1.0, 0.22, 0.42}, {1.0, 0.42, 0.85}, Material::fabric);
    for (double x : {-1.0, 0.84})
        m.box({x, -0.42, 0.42}, {x + 0.16, 0.22, 0.62}, Material::fabric);
    for (double x : {-0.82, 0.02})
        m.box({x, -0.38, 0.42}, {x + 0.80, 0.20, 0.52}, Material::fabric);
    return m;
}

Model makeBed() {
    Model m;
    m.box({-0.85, -1.05, 0.05}, {0.85, 1.05, 0.30}, Material::wood);
    m.box({-0.80, -1.00, 0.30}, {0.80, 0.98, 0.50}, Material::whiteBoard);
    m.box({-0.82, -1.02, 0.50}, {0.82, 0.35, 0.55}, Material::fabric);
    for (double x : {-0.72, 0.08})
        m.box({x, 0.50, 0.50}, {x + 0.64, 0.92, 0.63}, Material::whiteBoard);
    m.box({-0.88, 1.00, 0}, {0.88, 1.06, 1.0}, Material::wood);
    return m;
}

Model makeShelf(double width, double height, Random random) {
    Model m;
    constexpr double depth = 0.30, board = 0.025;
    for (double x : {-width / 2, width / 2 - board})
        m.box({x, -depth / 2, 0}, {x + board, depth / 2, height}, Material::wood);
    m.quad({-width / 2, depth / 2, 0}, {width / 2, depth / 2, 0}, {width / 2, depth / 2, height},
           {-width / 2, depth / 2, height}, Material::wood);
    int boards = static_cast<int>(height / 0.36);
    for (int i = 0; i <= boards; ++i) {
        double z = 0.04 + i * (height - 0.08) / boards;
        m.box({-width / 2 + board, -depth / 2, z - board / 2}, {width / 2 - board, depth / 2, z + board / 2},
              Material::wood);
        if (i == boards)
            break;
        // Books in runs of one height, with gaps between.
        double x = -width / 2 + 0.05;
        while (x < width / 2 - 0.20) {
            double run = random.uniform(0.08, 0.30), tall = random.uniform(0.18, 0.30);
            double end = std::min(x + run, width / 2 - 0.05);
            if (random.chance(0.8))
                m.box({x, -0.10, z + board / 2}, {end, 0.12, z + board / 2 + tall}, Material::books);
            x = end + 0.01;
        }
    }
    return m;
}

Model makeCupboard(double width, double height) {
    Model m;
    m.box({-width / 2, -0.28, 0.05}, {width / 2, 0.28, height}, Material::wood);
    m.box({-width / 2 - 0.02, -0.30, height}, {width / 2 + 0.02, 0.30, height + 0.04}, Material::wood);
    for (double x : {-0.05, 0.05})
        m.cylinder({x, -0.30, height * 0.45}, {x, -0.30, height * 0.6}, 0.01, Material::plastic);
    return m;
}

Model makeKitchen(double width) {
    Model m;
    m.box({-width / 2, -0.28, 0.10}, {width / 2, 0.30, 0.86}, Material::plastic);
    m.box({-width / 2, -0.24, 0}, {width / 2, 0.30, 0.10}, Material::screen);
    m.box({-width / 2, -0.31, 0.86}, {width / 2, 0.30, 0.90}, Material::plastic);
    m.box({-width / 2, -0.02, 1.45}, {width / 2, 0.30, 2.10}, Material::plastic);
    m.cylinder({0.1, 0.2, 0.90}, {0.1, 0.2, 1.15}, 0.015, Material::plastic);
    m.cylinder({0.1, 0.2, 1.15}, {0.1, 0.02, 1.12}, 0.015, Material::plastic);
    return m;
}

Model makePendantLamp(double drop) {
    Model m;
    m.cylinder({0, 0, -drop}, {0, 0, 0}, 0.008, Material::screen);
    m.frustum({0, 0, -drop - 0.22}, {0, 0, -drop}, 0.20, 0.05, Material::lampShade);
    m.sphere({0, 0, -drop - 0.13}, 0.05, Material::lampShade);
    return m;
}

Model makeTubeLamp(double size) {
    Model m;
    m.box({-size / 2, -0.10, -0.07}, {size / 2, 0.10, 0}, Material::lampShade);
    return m;
}

Model makePottedPlant(Random random) {
    Model m;
    m.frustum({0, 0, 0}, {0, 0, 0.35}, 0.13, 0.18, Material::plastic);
    m.disc({0, 0, 0.32}, {0, 0, 1}, 0.17, Material::bark);
    for (int i = 0; i < 60; ++i) {
        double turn = random.uniform(0, 2 * pi), out = random.uniform(0.03, 0.32),
               z = random.uniform(0.4, 1.3);
        m.disc({out * std::cos(turn), out * std::sin(turn), z},
               {random.normal(), random.normal(), random.normal() + 1}, random.uniform(0.04, 0.09),
               Material::leafBroad);
    }
    m.cylinder({0, 0, 0.32}, {0.02, 0.01, 1.1}, 0.012, Material::bark);
    return m;
}

Model makeDiningSet(int chairs) {
    Model m;
    double width = 0.7 * (chairs / 2) + 0.3;
    m.append(makeTable(width, 0.9, 0.75), {0, 0, 0});
    Model chair = makeChair();
    for (int i = 0; i < chairs; ++i) {
        double x = (i / 2 - (chairs / 2 - 1) * 0.5) * 0.7;
        bool front = i % 2 == 0;
        m.append(chair, {x, front ? -0.58 : 0.58, 0}, front ? pi + 0.1 * i : -0.08 * i);
    }
    return m;
}

} // namespace stipple::synth
