// What the vertex shader's walk through the octree finds, read back through transform feedback: the program,
// the texture and the buffers are the renderer's.
#pragma once

#include "client/core/frame_plan.hpp"
#include "shared/base/result.hpp"

#include <vector>

namespace stipple::test {

// Per node of the plan: of each point that is drawn, how many levels below its own node the finest drawn node
// lies that holds it. The style's sizes must be adaptive; a GL context must be current, `target` is a
// framebuffer of it that stays as it is.
Result<std::vector<std::vector<int>>> glesLevels(const FramePlan& plan, unsigned target);

} // namespace stipple::test
