// How much of a frame may be new: nodes that the frame before did not show have to be brought to the GPU, and
// too many at once would hold the frame up. What is left out comes with the next frames; where a coarser part
// of the same node was shown, that goes on being shown.
#pragma once

#include "client/core/frame_plan.hpp"

#include <cstdint>
#include <map>
#include <utility>

namespace stipple {

class UploadGate {
  public:
    // `before`: the plan of the frame before, which stays as long as this. `limitBytes` 0: everything passes.
    UploadGate(const FramePlan& before, std::uint64_t limitBytes);

    struct Verdict {
        bool passes = true;
        const DrawNode* instead = nullptr; // what was drawn of a node that does not pass; null: nothing
    };
    // Whether the node may be drawn. The first new one always may.
    Verdict judge(std::uint32_t cloud, const ResidentNode& node);

  private:
    const std::uint64_t limitBytes_;
    std::uint64_t newBytes_ = 0;
    std::map<std::pair<std::uint32_t, NodeKey>, const DrawNode*> before_; // by cloud
};

} // namespace stipple
