// Trees, bushes and hedges. Leaves are discs: a beam is stopped in part by each disc it meets, so pulses
// give several returns, and each return lies on an exact surface.
#pragma once

#include "converter/synth/model.hpp"
#include "converter/synth/random.hpp"

namespace stipple::synth {

// About 10 m tall; forests and gardens place them scaled. Leaf area index about 3.
Model makeBroadleaf(Random random);
Model makeConifer(Random random);
Model makeBush(Random random);               // 1.5 m
Model makeHedge(double size, Random random); // along x, 1.3 m tall, 0.8 m wide
Model makeReeds(Random random);              // 1.2 m, for river banks

} // namespace stipple::synth
