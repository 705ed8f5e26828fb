#include "converter/build/subtree_plan.hpp"
#include "tests/unit/converter/build/test_scan.hpp"
#include "tests/unit/converter/build/tiled_rows.hpp"

#include <map>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {
// Points without attributes, dealt into cells of `level`.
Tiles tilesOf(const std::vector<Vec3i>& positions, int level, ScratchFile* file, std::size_t memoryBytes) {
    BoxI bounds;
    for (Vec3i p : positions)
        bounds.extend(p);
    Tiles tiles;
    tiles.layout = RowLayout(Schema{}, bounds);
    auto cube = rootCubeOf(bounds);
    REQUIRE(cube.ok());
    tiles.grid = {*cube, std::min(level, cube->bits), {}};
    tiles.pool = std::make_unique<RowPool>(memoryBytes, file);
    tiles.cells = std::make_unique<RowStore>(*tiles.pool, tiles.layout.rowBytes(), tiles.grid.cells());
    PointBatch batch;
    batch.resize(Schema{}, 1);
    Bytes row(tiles.layout.rowBytes());
    for (Vec3i p : positions) {
        batch.positions[0] = p;
        tiles.layout.pack(batch, std::vector<std::uint32_t>{0}, row.data());
        if (!tiles.cells->append(tiles.grid.cellOf(p), row.data(), 1))
            FAIL("a row is lost");
    }
    return tiles;
}

std::vector<Vec3i> surface(std::size_t count) {
    return surfaceScan(0, count, 17).points.positions;
}

// Most points of it in one small place, some of these in one still smaller, and a pile.
std::vector<Vec3i> clustered() {
    std::vector<Vec3i> points = surface(1000);
    std::mt19937_64 random(6);
    auto spread = [&](Vec3i corner, std::uint64_t width, int count) {
        for (int i = 0; i < count; ++i)
            points.push_back(corner + Vec3i{static_cast<std::int64_t>(random() % width),
                                            static_cast<std::int64_t>(random() % width),
                                            static_cast<std::int64_t>(random() % width)});
    };
    spread({31000, 17000, 100}, 300, 1500);
    spread({31100, 17100, 200}, 4, 1000);
    spread({55555, 33333, 77}, 1, 800); // a pile
    points.push_back({-4000000, -4000000, -4000000});
    return points;
}

using Plan = std::map<NodeKey, std::uint64_t>; // points of each subtree

// Plans, and checks that the plan parts the points into the largest nodes of no more than `most`.
Plan checkedPlan(const std::vector<Vec3i>& positions, int level, std::uint64_t most,
                 std::size_t memoryBytes) {
    TemporaryFolder folder;
    auto file = ScratchFile::create(folder / "points");
    REQUIRE(file.ok());
    Tiles tiles = tilesOf(positions, level, file->get(), memoryBytes);
    auto plan = planSubtrees(tiles, most, nullptr);
    REQUIRE(plan.ok());

    const RootCube& cube = tiles.grid.cube;
    std::map<int, Plan> levels;
    auto pointsAt = [&](int at) -> Plan& {
        Plan& counts = levels[at];
        if (counts.empty())
            for (Vec3i p : positions)
                ++counts[cube.keyOf(p, at)];
        return counts;
    };
    std::vector<std::string> found, expected, part;
    Plan result;
    std::size_t outside = 0, aboveMost = 0, notLargest = 0, inTiles = 0;
    for (const PlannedSubtree& subtree : plan->subtrees) {
        part.clear();
        for (const CellRef& cell : subtree.cells)
            addPoints(tiles.layout, *cell.store, cell.cell, part);
        CHECK(part.size() == subtree.points);
        std::set<std::string> distinct(part.begin(), part.end());
        for (const std::string& point : part)
            outside += cube.keyOf(positionOf(point), subtree.key.level) == subtree.key ? 0 : 1;
        bool pile = distinct.size() == 1;
        aboveMost += subtree.points <= most || pile ? 0 : 1;
        // A resumed run plans again with the cells of the tiles, so what was divided stays there.
        inTiles += subtree.points > most && subtree.cells[0].store == tiles.cells.get() ? 1 : 0;
        if (subtree.key.level > 0 && subtree.points <= most)
            notLargest += pointsAt(subtree.key.level - 1)[subtree.key.parent()] > most ? 0 : 1;
        CHECK(result.emplace(subtree.key, subtree.points).second);
        found.insert(found.end(), part.begin(), part.end());
    }
    CHECK(outside == 0);
    CHECK(aboveMost == 0);
    CHECK(notLargest == 0);
    CHECK(inTiles == 0);
    for (Vec3i p : positions)
        expected.emplace_back(reinterpret_cast<const char*>(&p), sizeof p);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    CHECK((found == expected)); // every point, in one subtree
    return result;
}
} // namespace

TEST_CASE("subtrees part the points into the largest nodes that are small enough", "[plan]") {
    for (std::uint64_t most : {300u, 1000u})
        checkedPlan(surface(5000), 3, most, 1 << 27);
    for (std::uint64_t most : {200u, 700u})
        checkedPlan(clustered(), 3, most, 1 << 27);
    CHECK(checkedPlan(surface(5000), 3, 20000, 1 << 27).size() == 1);
    CHECK(checkedPlan({{1, 2, 3}}, 3, 10, 1 << 27).size() == 1);
}

TEST_CASE("the plan does not depend on the cells, nor on the memory", "[plan]") {
    std::vector<Vec3i> points = clustered();
    points.erase(std::remove(points.begin(), points.end(), Vec3i{55555, 33333, 77}), points.end());
    Plan expected = checkedPlan(points, 3, 300, 1 << 27);
    CHECK(expected.size() > 20);
    for (int level : {0, 1, 2, 4, 5})
        CHECK(checkedPlan(points, level, 300, 1 << 27) == expected);
    CHECK(checkedPlan(points, 6, 300, 0) == expected);
}

TEST_CASE("points at one position are one subtree, however many", "[plan]") {
    std::vector<Vec3i> pile(5000, Vec3i{7, 8, 9});
    Plan one = checkedPlan(pile, 0, 100, 1 << 27);
    REQUIRE(one.size() == 1);
    CHECK(one.begin()->second == 5000);
    pile.push_back({7, 8, 10}); // the next grid step: a cube of one bit
    CHECK(checkedPlan(pile, 0, 100, 1 << 27).size() == 2);
    pile.push_back({std::int64_t{1} << 51, 0, 0}); // neighbours can't be parted at the deepest level
    Plan wide;
    TemporaryFolder folder;
    auto file = ScratchFile::create(folder / "points");
    REQUIRE(file.ok());
    Tiles tiles = tilesOf(pile, 2, file->get(), 1 << 27);
    auto plan = planSubtrees(tiles, 100, nullptr);
    REQUIRE(plan.ok());
    std::uint64_t points = 0;
    for (const PlannedSubtree& subtree : plan->subtrees) {
        points += subtree.points;
        CHECK(subtree.key.level <= maxLevel);
    }
    CHECK(points == pile.size());
}

TEST_CASE("a plan of no points is empty, one that is stopped is cancelled", "[plan]") {
    Tiles none = tilesOf({}, 3, nullptr, 1 << 27);
    auto empty = planSubtrees(none, 100, nullptr);
    REQUIRE(empty.ok());
    CHECK(empty->subtrees.empty());
    Tiles tiles = tilesOf(clustered(), 1, nullptr, 1 << 27);
    std::atomic<bool> stop{true};
    auto stopped = planSubtrees(tiles, 100, &stop);
    REQUIRE_FALSE(stopped.ok());
    CHECK(stopped.error().code == ErrorCode::cancelled);
}
