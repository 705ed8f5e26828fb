#include "tests/support/test_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace stipple::test {

std::vector<Attribute> attributesOf(const TestNode& node) {
    std::vector<Attribute> attributes;
    auto add = [&](std::string_view name, AttributeType type) {
        attributes.push_back({std::string(name), type});
    };
    if (node.hasIntensity) {
        add(attribute_names::intensity, AttributeType::f32);
        add(attribute_names::classification, AttributeType::u8);
        add(attribute_names::gpsTime, AttributeType::f64);
    }
    if (node.hasNormals)
        for (std::string_view name : {"NormalX", "NormalY", "NormalZ"})
            add(name, AttributeType::f32);
    return attributes;
}

namespace {

NodeColumns columnsOf(const TestNode& node) {
    ByteWriter values;
    auto write = [&](auto member) {
        for (const TestPoint& p : node.points)
            values.write(member(p));
    };
    if (node.hasIntensity) {
        write([](const TestPoint& p) { return p.intensity; });
        write([](const TestPoint& p) { return p.classification; });
        write([](const TestPoint& p) { return p.gpsTime; });
    }
    for (int axis = 0; node.hasNormals && axis < 3; ++axis)
        write([&](const TestPoint& p) { return p.normal[axis]; });
    NodeColumns columns{static_cast<std::uint32_t>(node.points.size()), {}, values.take()};
    for (const Attribute& attribute : attributesOf(node))
        columns.columns.push_back({static_cast<std::int32_t>(columns.columns.size()),
                                   static_cast<std::uint32_t>(attribute.size())});
    return columns;
}

} // namespace

std::shared_ptr<const ResidentNode> residentNode(const TestNode& node) {
    auto resident = std::make_shared<ResidentNode>();
    resident->id = nextResidentNodeId();
    resident->nodeBits = node.nodeBits;
    resident->positionShift = std::max(0, node.nodeBits - positionWordBits);
    resident->pointCount = resident->totalPoints = static_cast<std::uint32_t>(node.points.size());
    int shift = resident->positionShift;
    std::uint32_t lowMask = (1u << shift) - 1;
    for (const TestPoint& p : node.points) {
        std::uint32_t y = p.y >> shift;
        resident->positionWords.push_back(packPositionWord0(p.x >> shift, y));
        resident->positionWords.push_back(packPositionWord1(y, p.z >> shift));
        if (shift > 0)
            resident->positionLowWords.push_back((p.z & lowMask) << 20 | (p.y & lowMask) << 10 |
                                                 (p.x & lowMask));
        if (node.hasColour)
            resident->colourWords.push_back(p.r | std::uint32_t{p.g} << 8 | std::uint32_t{p.b} << 16 |
                                            0xFF000000u);
    }
    if (node.hasIntensity || node.hasNormals)
        resident->columns = columnsOf(node);
    return resident;
}

FramePlan testPlan(const std::vector<TestNode>& nodes, const TestView& view, const Style& style) {
    FramePlan plan;
    plan.width = view.width;
    plan.height = view.height;
    plan.style = style;
    plan.view.projection = view.projection;
    plan.view.forward = normalized(view.target - view.position);
    plan.view.right = normalized(cross(plan.view.forward, view.up));
    plan.view.up = cross(plan.view.right, plan.view.forward);
    plan.view.tanHalfFovY = view.tanHalfFovY;
    plan.view.halfHeight = view.halfHeight;
    plan.view.aspect = static_cast<double>(view.width) / view.height;
    plan.view.near = view.near;
    plan.view.far = view.far;
    std::uint32_t index = 0;
    for (const TestNode& node : nodes) {
        auto resident = std::make_shared<ResidentNode>(*residentNode(node));
        resident->key = node.spacing > 0 ? node.key : NodeKey{8, index, 0, 0};
        ++index;
        DrawNode draw;
        draw.spacing = node.spacing;
        if (node.spacing > 0 && resident->totalPoints > 0)
            draw.density = rankDensity(resident->key.level, node.spacing, resident->totalPoints);
        draw.pointCount = resident->pointCount;
        draw.scale = node.scale;
        for (int axis = 0; axis < 3; ++axis) {
            double steps = (view.position[axis] - node.corner[axis]) / draw.scale[axis];
            auto i = static_cast<std::size_t>(axis);
            double cell = std::floor(steps);
            // A fraction that rounds to 1 belongs to the next cell.
            auto fraction = static_cast<float>(steps - cell);
            if (fraction >= 1) {
                fraction = 0;
                cell += 1;
            }
            draw.cameraCell[i] = static_cast<std::int32_t>(cell);
            draw.cameraFraction[i] = fraction;
            draw.cameraOffset[i] = steps - cell;
        }
        draw.node = std::move(resident);
        plan.nodes.push_back(std::move(draw));
    }
    paintPlan(plan, nodes);
    return plan;
}

void paintPlan(FramePlan& plan, const std::vector<TestNode>& nodes) {
    Result<Clips> clips = Clips::make(plan.style.clipBoxes, plan.style.clipRegions);
    if (!clips.ok())
        std::abort(); // the test's boxes are wrong
    for (std::size_t n = 0; n < nodes.size(); ++n) {
        Schema schema{attributesOf(nodes[n])};
        Grid grid{nodes[n].scale, nodes[n].corner};
        std::int64_t side = std::int64_t{1} << nodes[n].nodeBits;
        BoxD box;
        box.extend(nodes[n].corner);
        box.extend(grid.toWorld({side, side, side}));
        Painter painter(plan.style, *clips, schema, grid, true,
                        plan.style.detail.mode == DetailMode::continuous);
        const ResidentNode& resident = *plan.nodes[n].node;
        RankDensity density = rankDensity(resident.key.level, std::ldexp(1.0, -resident.key.level),
                                          std::max(1u, resident.totalPoints));
        plan.nodes[n].paint = painter.paint({plan.nodes[n].node, {}, {0, 0, 0}, box, false, density, 1});
        std::vector columns{std::make_shared<const NodeColumns>(plan.nodes[n].node->columns)};
        plan.nodes[n].normals = plan.style.shape == PointShape::disc ? packNormals(schema, columns) : nullptr;
    }
}

std::vector<TestNode> randomOctree(std::uint64_t seed, int depth, std::uint32_t pointsPerNode, int rootBits,
                                   Vec3d corner, double scale) {
    TestRandom random(seed);
    std::vector<TestNode> nodes;
    std::vector<NodeKey> keys{{}};
    for (std::size_t i = 0; i < keys.size(); ++i) {
        NodeKey key = keys[i];
        int bits = rootBits - key.level;
        double side = std::ldexp(scale, bits);
        TestNode node = randomNode(random.next(), pointsPerNode, bits,
                                   corner + Vec3d{key.x * side, key.y * side, key.z * side}, scale);
        node.key = key;
        node.spacing = std::ldexp(scale, bits - 3);
        nodes.push_back(std::move(node));
        for (int child = 0; child < 8 && key.level < depth; ++child)
            if (key.level == 0 || random.below(3) > 0)
                keys.push_back(key.child(child));
    }
    return nodes;
}

TestView octreeView(Projection projection, double halfHeight) {
    TestView view;
    view.position = {1.2345, -17.7, 3.21};
    view.target = {0.3, 0.1, -0.2};
    view.projection = projection;
    view.halfHeight = halfHeight;
    return view;
}

int finestLevel(const std::vector<TestNode>& octree, const TestNode& node, const TestPoint& point) {
    int level = 0;
    auto inside = [](std::uint64_t at, std::uint64_t first, std::uint64_t side) {
        return at >= first && at < first + side;
    };
    // In steps of the root.
    auto corner = [](const TestNode& of, std::uint32_t coordinate) {
        return std::uint64_t{coordinate} << of.nodeBits;
    };
    for (const TestNode& other : octree) {
        std::uint64_t side = std::uint64_t{1} << other.nodeBits;
        if (inside(corner(node, node.key.x) + point.x, corner(other, other.key.x), side) &&
            inside(corner(node, node.key.y) + point.y, corner(other, other.key.y), side) &&
            inside(corner(node, node.key.z) + point.z, corner(other, other.key.z), side))
            level = std::max(level, int{other.key.level});
    }
    return level;
}

double finestSpacing(const std::vector<TestNode>& octree, const TestNode& node, const TestPoint& point) {
    return std::ldexp(node.spacing, node.key.level - finestLevel(octree, node, point));
}

void addNormals(TestNode& node, std::uint64_t seed) {
    TestRandom random(seed);
    node.hasNormals = true;
    for (TestPoint& p : node.points) {
        Vec3d n;
        do
            n = {2 * random.unit() - 1, 2 * random.unit() - 1, 2 * random.unit() - 1};
        while (dot(n, n) > 1 || dot(n, n) < 0.01);
        bool none = random.below(20) == 0;
        for (int axis = 0; axis < 3; ++axis)
            p.normal[axis] = none ? 0 : static_cast<float>(n[axis] * 3);
    }
}

std::uint64_t TestRandom::next() { // splitmix64
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

TestNode randomNode(std::uint64_t seed, std::uint32_t count, int nodeBits, Vec3d corner, double scale) {
    TestRandom random(seed);
    TestNode node;
    node.nodeBits = nodeBits;
    node.corner = corner;
    node.scale = {scale, scale, scale};
    auto coordinate = [&] { return static_cast<std::uint32_t>(random.next() >> (64 - nodeBits)); };
    auto level = [&] { return static_cast<std::uint8_t>(random.below(256)); };
    for (std::uint32_t i = 0; i < count; ++i) {
        TestPoint p;
        p.x = coordinate();
        p.y = coordinate();
        p.z = coordinate();
        p.r = level();
        p.g = level();
        p.b = level();
        p.intensity = static_cast<float>(random.below(4096));
        p.classification = static_cast<std::uint8_t>(7 * i % 23);
        p.gpsTime = 390583952.3 + 1e-4 * static_cast<double>(311 * i % 1000);
        node.points.push_back(p);
    }
    return node;
}

} // namespace stipple::test
