#include "client/core/upload_gate.hpp"

namespace stipple {

UploadGate::UploadGate(const FramePlan& before, std::uint64_t limitBytes) : limitBytes_(limitBytes) {
    if (limitBytes_ > 0)
        for (const DrawNode& drawn : before.nodes)
            before_.emplace(std::pair(drawn.cloud, drawn.node->key), &drawn);
}

UploadGate::Verdict UploadGate::judge(std::uint32_t cloud, const ResidentNode& node) {
    if (limitBytes_ == 0)
        return {};
    auto shown = before_.find({cloud, node.key});
    const DrawNode* before = shown == before_.end() ? nullptr : shown->second;
    if (before && before->node->id == node.id)
        return {};
    std::uint64_t words =
        node.positionWords.size() + node.positionLowWords.size() + node.pointCount; // and a colour
    if (newBytes_ > 0 && newBytes_ + 4 * words > limitBytes_)
        return {false, before};
    newBytes_ += 4 * words;
    return {};
}

} // namespace stipple
