#include "client/core/upload_gate.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

std::shared_ptr<const ResidentNode> node(std::uint64_t id, const NodeKey& key, std::uint32_t points) {
    auto made = std::make_shared<ResidentNode>();
    made->id = id;
    made->key = key;
    made->pointCount = points;
    made->positionWords.resize(2 * points);
    return made;
}

FramePlan planOf(std::vector<std::shared_ptr<const ResidentNode>> nodes) {
    FramePlan plan;
    for (auto& one : nodes) {
        plan.nodes.emplace_back();
        plan.nodes.back().node = std::move(one);
        plan.nodes.back().cloud = 1;
    }
    return plan;
}

} // namespace

TEST_CASE("new nodes pass until a frame has enough, those of the frame before always") {
    NodeKey root{}, left{1, 0, 0, 0}, right{1, 1, 0, 0};
    FramePlan before = planOf({node(1, root, 100), node(2, left, 50)});
    UploadGate gate(before, 1200); // 100 points
    CHECK(gate.judge(1, *node(1, root, 100)).passes);
    CHECK(gate.judge(1, *node(3, right, 60)).passes);
    UploadGate::Verdict refined = gate.judge(1, *node(4, left, 70)); // 60 + 70 points
    CHECK_FALSE(refined.passes);
    REQUIRE(refined.instead);
    CHECK(refined.instead->node->id == 2);
    CHECK(gate.judge(1, *node(5, {1, 0, 1, 0}, 40)).passes);      // 60 + 40
    UploadGate::Verdict other = gate.judge(2, *node(6, root, 1)); // of another cloud
    CHECK_FALSE(other.passes);
    CHECK_FALSE(other.instead);
}

TEST_CASE("the first new node passes, however large; without a limit all do") {
    FramePlan before;
    UploadGate tight(before, 1);
    CHECK(tight.judge(1, *node(1, {}, 1'000'000)).passes);
    CHECK_FALSE(tight.judge(1, *node(2, {1, 0, 0, 0}, 1)).passes);
    UploadGate open(before, 0);
    for (std::uint64_t id = 1; id < 5; ++id)
        CHECK(open.judge(1, *node(id, {}, 1'000'000)).passes);
}
