// Frame plans made by hand: clouds of integer points in one or several nodes, seen by a camera given in
// world coordinates. What the client core does for real clouds, in a few lines of double precision.
#pragma once

#include "client/core/frame_plan.hpp"

#include <cstdint>
#include <vector>

namespace stipple::test {

struct TestPoint {
    std::uint32_t x = 0, y = 0, z = 0; // grid steps inside the node
    std::uint8_t r = 255, g = 255, b = 255;
    float intensity = 0;
    std::uint8_t classification = 0;
    double gpsTime = 0;
    Vec3<float> normal{}; // zero: none
};

// A cube of 2^nodeBits grid steps of `scale` world units whose lowest corner is at `corner` (world).
struct TestNode {
    std::vector<TestPoint> points;
    int nodeBits = 16;
    Vec3d corner{0, 0, 0};
    Vec3d scale{0.01, 0.01, 0.01};
    bool hasColour = true, hasIntensity = true; // without: nor classes and times
    bool hasNormals = false;
    NodeKey key;        // level 0: testPlan gives each node a key of its own, at level 8
    double spacing = 0; // of its points, world units

    Vec3d world(const TestPoint& p) const {
        return {corner.x + scale.x * p.x, corner.y + scale.y * p.y, corner.z + scale.z * p.z};
    }
};

struct TestView {
    Vec3d position{0, -10, 0}, target{0, 0, 0}, up{0, 0, 1};
    Projection projection = Projection::perspective;
    double tanHalfFovY = 0.5, halfHeight = 5, near = 0.1, far = 1000;
    int width = 160, height = 120;
};

std::shared_ptr<const ResidentNode> residentNode(const TestNode& node);
FramePlan testPlan(const std::vector<TestNode>& nodes, const TestView& view, const Style& style = {});
// Paints a plan of these nodes anew, after its style was changed.
void paintPlan(FramePlan& plan, const std::vector<TestNode>& nodes);

// What a node's points carry: Intensity (float32), Classification, GPS Time; NormalX, NormalY, NormalZ; or
// nothing.
std::vector<Attribute> attributesOf(const TestNode& node);

// The nodes of an octree of `depth` levels below its root, some branches of which end sooner. Each holds
// `pointsPerNode` random points; the root is 2^rootBits steps wide. Root spacing: an eighth of its side.
std::vector<TestNode> randomOctree(std::uint64_t seed, int depth, std::uint32_t pointsPerNode, int rootBits,
                                   Vec3d corner, double scale);
// From near one of 10 units around the origin, past all of its sides.
TestView octreeView(Projection projection, double halfHeight = 7);
// The spacing of the finest node that holds the point, found by looking at all nodes of such an octree.
double finestSpacing(const std::vector<TestNode>& octree, const TestNode& node, const TestPoint& point);
int finestLevel(const std::vector<TestNode>& octree, const TestNode& node, const TestPoint& point);

// Gives each point a direction of its own, any as likely as another; a few of them none.
void addNormals(TestNode& node, std::uint64_t seed);

// Numbers in [0, 1) that are the same everywhere.
class TestRandom {
  public:
    explicit TestRandom(std::uint64_t seed) : state_(seed) {}
    std::uint64_t next();
    double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
    std::uint32_t below(std::uint32_t limit) {
        return static_cast<std::uint32_t>(unit() * static_cast<double>(limit));
    }

  private:
    std::uint64_t state_;
};

// `count` points anywhere in the node, with random colours, intensities 0..4095, classes 0..22 and
// GPS times of a tenth of a second, which float can't tell apart.
TestNode randomNode(std::uint64_t seed, std::uint32_t count, int nodeBits, Vec3d corner, double scale);

} // namespace stipple::test
