#include "client/core/selection.hpp"

#include "client/core/camera.hpp"
#include "client/core/frustum.hpp"

#include <catch2/catch.hpp>

#include <map>
#include <random>

using namespace stipple;

namespace {

// A tree on a square of 64 × 64 m, 1 m steps, seen from above; each node has 100 points:
//
//          r                 level 0
//      a   b   c   d         level 1: children 0..3 (lower left, lower right, upper left, upper right)
//     a0   |   :             level 2: a0 below a; b0 b1 below b; c's children are in a chunk not here yet
//        b0 b1
const std::map<std::string, NodeKey> keys{
    {"r", {0, 0, 0, 0}},  {"a", {1, 0, 0, 0}},  {"b", {1, 1, 0, 0}},
    {"c", {1, 0, 1, 0}},  {"d", {1, 1, 1, 0}},  {"a0", {2, 0, 0, 0}},
    {"b0", {2, 2, 0, 0}}, {"b1", {2, 3, 0, 0}}, {"c0", {2, 0, 2, 0}},
};

NodeEntry entryOf(const std::string& name, std::uint8_t childMask, std::uint32_t points = 100) {
    NodeEntry entry;
    entry.key = keys.at(name);
    entry.childMask = childMask;
    entry.pointCount = points;
    if (name == "c")
        entry.childChunk = {1000, 50};
    return entry;
}

std::shared_ptr<const CloudMetadata> squareMetadata() {
    auto metadata = std::make_shared<CloudMetadata>();
    metadata->grid.scale = {1, 1, 1};
    metadata->rootCube = {{0, 0, 0}, 6};
    metadata->bounds.extend(Vec3i{0, 0, 0});
    metadata->bounds.extend(Vec3i{63, 63, 10});
    metadata->pointCount = 10'000;
    metadata->spacing = 1;
    return metadata;
}

struct Tree {
    Hierarchy hierarchy;
    std::vector<NodeResidency> residency;
    Camera camera;
    SelectionInput input;
    std::vector<SelectionCloud> clouds;
    int width = 600;

    Tree() {
        auto created = Hierarchy::create(
            squareMetadata(), {entryOf("r", 0b1111), entryOf("a", 0b1), entryOf("b", 0b11), entryOf("c", 0b1),
                               entryOf("d", 0), entryOf("a0", 0), entryOf("b0", 0), entryOf("b1", 0)});
        REQUIRE(created.ok());
        hierarchy = std::move(*created);
        residency.resize(hierarchy.size());
        // Orthographic, all in view: pixels = radius × 600 / 80: root 416, level 1 208, level 2 104.
        camera.projection = Projection::orthographic;
        camera.position = {32, 32, 100};
        camera.target = {32, 32, 0};
        camera.orthoHeight = 80;
        input.height = 600;
        input.pointBudget = 1'000'000;
        input.byteBudget = 1ull << 30;
        input.minNodePixels = 10;
    }

    std::size_t index(const std::string& name) const {
        for (std::size_t i = 0; i < hierarchy.size(); ++i)
            if (hierarchy.node(i).entry.key == keys.at(name))
                return i;
        FAIL("no node " << name);
        return 0;
    }
    void arrive(const std::string& name, std::uint32_t points = 100) {
        residency[index(name)].points = points;
    }

    Selection select() {
        residency.resize(hierarchy.size());
        input.view = viewTransform(camera, width, input.height, hierarchy.metadata().worldBounds());
        clouds = {{&hierarchy, residency, 12}};
        input.clouds = clouds;
        return stipple::select(input);
    }

    std::string nameOf(std::uint32_t node) const {
        for (const auto& [name, key] : keys)
            if (key == hierarchy.node(node).entry.key)
                return name;
        return "?";
    }
    std::string selected(const Selection& selection) const {
        std::string text;
        for (const SelectedNode& node : selection.nodes)
            text += nameOf(node.node) + " ";
        return text;
    }
    std::string drawn(const Selection& selection) const {
        std::string text;
        for (const SelectedNode& node : selection.nodes)
            if (node.drawPoints > 0)
                text += nameOf(node.node) + " ";
        return text;
    }
    // With the strata of each: "r1 a4".
    std::string wanted(const Selection& selection) const {
        std::string text;
        for (const WantedNode& node : selection.loads)
            text += nameOf(node.node) + ":" + std::to_string(node.strata) + " ";
        return text;
    }
};

} // namespace

TEST_CASE("frame by frame: coarse beginnings first, then whole nodes, never a child before its parent") {
    Tree tree;
    // Frame 1: nothing is here. All is selected, coarse before fine; the root covers more than half the
    // picture, so its first stratum comes ahead by itself.
    Selection frame = tree.select();
    CHECK(tree.selected(frame) == "r a c b d a0 b0 b1 ");
    CHECK(tree.drawn(frame) == "");
    CHECK(tree.wanted(frame) == "r:1 a:4 c:4 b:4 d:4 a0:4 b0:4 b1:4 ");
    REQUIRE(frame.chunks.size() == 1);
    CHECK(tree.nameOf(frame.chunks[0].node) == "c");
    CHECK(frame.counters.nodesKnown == 8);
    CHECK(frame.counters.nodesVisited == 8);
    CHECK(frame.counters.nodesSelected == 8);
    CHECK(frame.counters.nodesWaiting == 8);
    CHECK(frame.counters.chunksWaiting == 1);
    CHECK(frame.counters.pointsSelected == 800);
    CHECK_FALSE(frame.counters.complete);

    // Frame 2: a first stratum of the root is here: it is drawn, and the rest of it is wanted.
    tree.arrive("r", 13);
    frame = tree.select();
    CHECK(tree.drawn(frame) == "r ");
    CHECK(frame.nodes[0].drawPoints == 13);
    CHECK(tree.wanted(frame) == "r:4 a:4 c:4 b:4 d:4 a0:4 b0:4 b1:4 ");

    // Frame 3: b0 came before its parent b: it waits, so that no fine patch has a hole at its edge.
    tree.arrive("r");
    tree.arrive("b0");
    frame = tree.select();
    CHECK(tree.drawn(frame) == "r ");
    CHECK(tree.wanted(frame) == "a:4 c:4 b:4 d:4 a0:4 b1:4 ");

    // Frame 4: b is here, and b0 with it.
    tree.arrive("b");
    frame = tree.select();
    CHECK(tree.drawn(frame) == "r b b0 ");

    // Frame 5: the chunk below c came.
    REQUIRE(tree.hierarchy.add(tree.index("c"), {entryOf("c0", 0)}).ok());
    for (const char* name : {"a", "c", "d", "a0", "b1"})
        tree.arrive(name);
    frame = tree.select();
    CHECK(frame.chunks.empty());
    CHECK(tree.wanted(frame) == "c0:4 ");
    CHECK_FALSE(frame.counters.complete);

    // Frame 6: all is here.
    tree.arrive("c0");
    frame = tree.select();
    CHECK(tree.drawn(frame) == "r a c b d a0 c0 b0 b1 ");
    CHECK(frame.counters.complete);
    CHECK(frame.counters.pointsDrawn == 900);
    CHECK(frame.loads.empty());
}

TEST_CASE("the budget is met exactly, the last node draws a prefix, and only its strata are wanted") {
    Tree tree;
    tree.input.pointBudget = 230;
    Selection frame = tree.select();
    CHECK(tree.selected(frame) == "r a c ");
    CHECK(frame.nodes[2].points == 30);
    CHECK(frame.counters.pointsSelected == 230);
    CHECK(frame.counters.pointsConsidered == 600);
    CHECK(frame.counters.nodesOverBudget == 3);  // b, d, and a0 were in the queue
    CHECK(tree.wanted(frame) == "r:1 a:4 c:3 "); // 13, 25, 50 points in 1, 2, 3 strata
    tree.arrive("r");
    tree.arrive("a");
    tree.arrive("c", 50);
    frame = tree.select();
    CHECK(frame.counters.pointsDrawn == 230);
    CHECK(frame.counters.complete);
}

TEST_CASE("the bytes of the cache are a budget too") {
    Tree tree;
    tree.input.byteBudget = 12 * 250;
    Selection frame = tree.select();
    CHECK(frame.counters.pointsSelected == 250);
    CHECK(frame.counters.nodesOverBudget > 0);
}

TEST_CASE("nodes below the smallest size are left out, but never a root") {
    Tree tree;
    tree.input.minNodePixels = 150;
    Selection frame = tree.select();
    CHECK(tree.selected(frame) == "r a c b d ");
    CHECK(frame.counters.nodesTooSmall == 3);
    CHECK(frame.chunks.empty()); // c's child would be too small as well
    tree.input.minNodePixels = 1e6;
    CHECK(tree.selected(tree.select()) == "r ");
}

TEST_CASE("what is outside the picture is skipped with everything below it") {
    Tree tree;
    tree.camera.position = {56, 8, 100}; // over b1
    tree.camera.target = {56, 8, 0};
    tree.camera.orthoHeight = 12;
    Selection frame = tree.select();
    CHECK(tree.selected(frame) == "r b b1 ");
    CHECK(frame.counters.nodesOutsideFrustum == 4); // a, c, d, b0; a0 was never looked at
    CHECK(frame.chunks.empty());
}

TEST_CASE("a node that failed does not hold back what is below it") {
    Tree tree;
    for (const char* name : {"r", "a", "c", "d", "a0", "b0", "b1"})
        tree.arrive(name);
    tree.residency[tree.index("b")].failed = true;
    Selection frame = tree.select();
    CHECK(tree.drawn(frame) == "r a c d a0 b0 b1 ");
    CHECK(frame.counters.nodesWaiting == 0);
    CHECK(frame.loads.empty());
}

TEST_CASE("a chunk that failed is not asked for again") {
    Tree tree;
    tree.hierarchy.markChildrenFailed(tree.index("c"));
    CHECK(tree.select().chunks.empty());
}

TEST_CASE("the order of clouds decides between equal sizes, and nothing else does") {
    Tree tree;
    tree.input.view = viewTransform(tree.camera, 600, 600, tree.hierarchy.metadata().worldBounds());
    std::vector<SelectionCloud> clouds{{&tree.hierarchy, tree.residency, 12},
                                       {&tree.hierarchy, tree.residency, 12}};
    tree.input.clouds = clouds;
    tree.input.pointBudget = 450;
    Selection first = select(tree.input), second = select(tree.input);
    std::string order;
    for (const SelectedNode& node : first.nodes)
        order += tree.nameOf(node.node) + std::to_string(node.cloud) + " ";
    CHECK(order == "r0 r1 a0 c0 b0 ");
    REQUIRE(first.nodes.size() == second.nodes.size());
    for (std::size_t i = 0; i < first.nodes.size(); ++i)
        CHECK(first.nodes[i].node == second.nodes[i].node);
}

TEST_CASE("nothing loaded, no clouds: an empty, complete selection") {
    SelectionInput input;
    input.height = 100;
    input.pointBudget = 10;
    CHECK(select(input).counters.complete);
    SelectionCloud unopened;
    input.clouds = {&unopened, 1};
    CHECK(select(input).nodes.empty());
}

TEST_CASE("strata for a number of points are the fewest that hold them") {
    CHECK(strataFor(800, 1) == 1);
    CHECK(strataFor(800, 100) == 1);
    CHECK(strataFor(800, 101) == 2);
    CHECK(strataFor(800, 400) == 3);
    CHECK(strataFor(800, 401) == 4);
    CHECK(strataFor(1, 1) == 1);
    CHECK(strataFor(0, 0) == 1);
}

namespace {

// Another way to the same answer: clip each face of the box against the sides of the view volume.
bool seenByClipping(const ViewTransform& view, const BoxD& box) {
    auto inside = [&](Vec3d p, int side) {
        Vec3d r = p - view.eye;
        bool perspective = view.projection == Projection::perspective;
        double half = perspective ? dot(r, view.forward) * view.tanHalfFovY : view.halfHeight;
        double along = side < 2 ? dot(r, view.right) / view.aspect : dot(r, view.up);
        return half + (side % 2 ? along : -along);
    };
    for (int face = 0; face < 6; ++face) {
        int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
        std::vector<Vec3d> polygon(4);
        for (std::size_t i = 0; i < 4; ++i) {
            polygon[i][axis] = face % 2 ? box.max[axis] : box.min[axis];
            polygon[i][u] = i == 1 || i == 2 ? box.max[u] : box.min[u];
            polygon[i][v] = i >= 2 ? box.max[v] : box.min[v];
        }
        for (int side = 0; side < 4 && !polygon.empty(); ++side) {
            std::vector<Vec3d> clipped;
            for (std::size_t i = 0; i < polygon.size(); ++i) {
                Vec3d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
                double da = inside(a, side), db = inside(b, side);
                if (da >= 0)
                    clipped.push_back(a);
                if ((da < 0) != (db < 0))
                    clipped.push_back(a + (b - a) * (da / (da - db)));
            }
            polygon = std::move(clipped);
        }
        if (!polygon.empty())
            return true;
    }
    return false;
}

} // namespace

TEST_CASE("weights follow the paper: 1 in the middle, the least at a side's middle and far away") {
    ViewTransform view;
    view.eye = {0, 0, 0};
    view.forward = {0, 1, 0};
    view.right = {1, 0, 0};
    view.up = {0, 0, 1};
    view.tanHalfFovY = 0.5;
    view.aspect = 2;
    view.near = 1;
    view.far = 101;
    PriorityWeights half{0.5, 0.5};
    PriorityWeights centre{0.5, 1}, depth{1, 0.2};
    CHECK(priorityWeight({}, view, {70, 100, 3}) == 1);
    CHECK(priorityWeight(half, view, {0, 1, 0}) == Approx(1));
    CHECK(priorityWeight(centre, view, {0, 10, 5}) == Approx(0.5));    // top
    CHECK(priorityWeight(centre, view, {10, 10, 0}) == Approx(0.5));   // right
    CHECK(priorityWeight(centre, view, {5, 10, 0}) == Approx(0.875));  // half way: 1 - 0.5 / 4
    CHECK(priorityWeight(centre, view, {100, 10, 99}) == Approx(0.5)); // beyond: no less
    CHECK(priorityWeight(depth, view, {0, 101, 0}) == Approx(0.2));
    CHECK(priorityWeight(depth, view, {0, 51, 0}) == Approx(1 - 0.8 / 4));
    CHECK(priorityWeight(half, view, {0, -3, 0}) == 1); // behind
}

TEST_CASE("with weights the middle is refined before the border") {
    Tree tree;
    tree.camera.position = {16, 16, 100}; // above a
    tree.camera.target = {16, 16, 0};
    tree.input.pointBudget = 450; // the root, and three and a half more
    CHECK(tree.selected(tree.select()) == "r a c b d ");
    tree.input.weights = {0.3, 1};
    CHECK(tree.selected(tree.select()) == "r a c b a0 ");
}

TEST_CASE("the frustum test agrees with clipping, for boxes before, around and behind the eye") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> unit(-1, 1);
    auto vector = [&](double scale) { return Vec3d{unit(random), unit(random), unit(random)} * scale; };
    int seen = 0, hidden = 0;
    for (int i = 0; i < 40'000; ++i) {
        Camera camera;
        camera.projection = i % 2 ? Projection::perspective : Projection::orthographic;
        camera.position = vector(2);
        camera.target = vector(2);
        camera.fovYDegrees = 20 + 100 * std::abs(unit(random));
        camera.orthoHeight = 0.2 + std::abs(unit(random));
        BoxD box;
        Vec3d centre = vector(3), half = vector(1);
        box.extend(centre + half);
        box.extend(centre - half);
        ViewTransform view = viewTransform(camera, 16, 9, BoxD{});
        bool expected = seenByClipping(view, box);
        REQUIRE(Frustum(view).intersects(box) == expected);
        ++(expected ? seen : hidden);
    }
    CHECK(seen > 3000);
    CHECK(hidden > 3000);
    CHECK_FALSE(Frustum(viewTransform(Camera{}, 16, 9, BoxD{})).intersects(BoxD{}));
}

TEST_CASE("a child never projects larger than its parent") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1, 1);
    ViewTransform view = viewTransform(Camera{}, 800, 600, BoxD{});
    for (int i = 0; i < 10'000; ++i) {
        Vec3d centre{unit(random) * 30, unit(random) * 30, unit(random) * 30};
        double side = 10 * std::abs(unit(random)), radius = side * std::sqrt(3.0) / 2;
        double parent = projectedPixels(view, 600, centre, radius);
        for (int c = 0; c < 8; ++c) {
            Vec3d child = centre + Vec3d{c & 1 ? .25 : -.25, c & 2 ? .25 : -.25, c & 4 ? .25 : -.25} * side;
            CHECK(projectedPixels(view, 600, child, radius / 2) <= parent * (1 + 1e-12));
        }
    }
}
