// What stands along roads and between towns: lamps, cars, pylons with their wires, a bridge.
#pragma once

#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

namespace stipple::synth {

Model makeLampPost();         // 7 m, arm towards -y
Model makeCar(Random random); // along x
Model makeBench();
Model makeTrafficSign();

// A lattice pylon for six conductors and a guard wire; the line runs along x.
struct Pylon {
    static constexpr double height = 31;
    static Model make();
    // Where wire i (0-5 conductors, 6 the guard wire) is held.
    static Vec3d holder(int wire);
};
// The seven wires between two pylons that stand at `a` and `b`, turned by yawA and yawB.
Model makePowerSpan(Vec3d a, double yawA, Vec3d b, double yawB);

// A wooden pole with two insulators, and its wires.
struct WoodPole {
    static constexpr double height = 8.5;
    static Model make();
};
Model makePoleSpan(Vec3d a, Vec3d b);

// A road bridge along y from y = -size/2 to size/2, deck surface at z = 0, on piers that reach `depth` down.
Model makeBridge(double size, double width, double depth);

} // namespace stipple::synth
