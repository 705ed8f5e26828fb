#include "converter/build/cell_chooser.hpp"
#include "converter/build/verify.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {
constexpr Sampling allSamplings[] = {Sampling::poisson, Sampling::random, Sampling::grid};

// Points in one node at `level` of 2^nodeBits steps, which all are candidates of.
struct Node {
    Schema schema = las::schemaOf(0);
    RowLayout layout;
    RootCube cube;
    SubtreeBuffers buffers;
    std::unique_ptr<Subtree> subtree;
    Candidates candidates;

    Node(int nodeBits, int level, const std::vector<Vec3i>& positions) {
        cube.bits = nodeBits + level;
        layout = RowLayout(schema, BoxI{{0, 0, 0}, Vec3i{1, 1, 1} * ((std::int64_t{1} << nodeBits) - 1)});
        PointBatch batch;
        batch.resize(schema, positions.size());
        batch.positions = positions;
        std::vector<std::uint32_t> all(positions.size());
        std::iota(all.begin(), all.end(), 0u);
        layout.pack(batch, all, buffers.rows(all.size(), layout.rowBytes()));
        NodeKey key;
        key.level = static_cast<std::uint8_t>(level);
        subtree = std::make_unique<Subtree>(layout, cube, key, buffers, std::array{all.size()});
        subtree->splitByCount(1);
        candidates.ranks = all;
        for (std::uint32_t rank : all) {
            Vec3i p = subtree->position(rank);
            candidates.positions.push_back({static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                            static_cast<std::uint32_t>(p.z)});
        }
    }
    // Indices of the candidates chosen.
    std::vector<std::size_t> choose(Sampling sampling, const Spacing& spacing) const {
        auto chooser = makeChooser(sampling, *subtree, spacing, {}, 1, true);
        std::vector<std::uint32_t> representatives(candidates.ranks.size());
        chooser->choose(candidates, 0, representatives);
        std::vector<std::size_t> chosen;
        for (std::size_t i = 0; i < representatives.size(); ++i)
            if (representatives[i] == i)
                chosen.push_back(i);
            else if (std::uint32_t other = representatives[i]; other != nobody)
                REQUIRE(representatives.at(other) == other); // a chosen one
        return chosen;
    }
};

std::vector<Vec3i> randomPoints(std::size_t count, int bits, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    std::uint64_t side = std::uint64_t{1} << bits;
    std::vector<Vec3i> points(count);
    for (Vec3i& p : points)
        p = {static_cast<std::int64_t>(random() % side), static_cast<std::int64_t>(random() % side),
             static_cast<std::int64_t>(random() % side / 8)};
    return points;
}

// By a search through all cells of an axis, in integers.
std::int64_t cellByDefinition(std::int64_t p, std::int64_t cells, std::int64_t side) {
    std::int64_t cell = 0;
    while ((cell + 1) * side <= p * cells)
        ++cell;
    return cell;
}

// For scales that are equal: distances are compared as integers.
std::vector<std::size_t> gridByDefinition(const Node& node, int nodeBits, std::int64_t cells) {
    const std::int64_t side = std::int64_t{1} << nodeBits;
    std::map<std::array<std::int64_t, 3>, std::pair<std::int64_t, std::size_t>> best;
    for (std::size_t i = 0; i < node.candidates.positions.size(); ++i) {
        std::array<std::int64_t, 3> cell;
        std::int64_t squared = 0;
        for (int axis = 0; axis < 3; ++axis) {
            std::int64_t p = node.candidates.positions[i][axis];
            std::int64_t c = cellByDefinition(p, cells, side);
            std::int64_t offset = 2 * cells * p - (2 * c + 1) * side;
            cell[static_cast<std::size_t>(axis)] = c;
            squared += offset * offset;
        }
        auto at = best.emplace(cell, std::make_pair(squared, i)).first;
        at->second = std::min(at->second, std::make_pair(squared, i));
    }
    std::vector<std::size_t> chosen;
    for (const auto& [cell, point] : best)
        chosen.push_back(point.second);
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

Spacing spacingOf(int density, Vec3d weights = {1, 1, 1}) {
    Spacing spacing;
    spacing.metric.weights = weights;
    spacing.density = density;
    return spacing;
}
} // namespace

TEST_CASE("grid takes the point nearest to each cell's centre, the first of equally near ones", "[sample]") {
    for (int density : {2, 7, 8, 13, 16}) {
        INFO("density " << density);
        auto cells = static_cast<std::int64_t>(std::lround(std::sqrt(std::ldexp(1.0, density))));
        Node wide(20, 0, randomPoints(5000, 20, 1)), narrow(5, 3, randomPoints(5000, 5, 2));
        CHECK(wide.choose(Sampling::grid, spacingOf(density)) == gridByDefinition(wide, 20, cells));
        CHECK(narrow.choose(Sampling::grid, spacingOf(density)) == gridByDefinition(narrow, 5, cells));
    }
}

TEST_CASE("cells follow the scales of the axes", "[sample]") {
    CHECK(SampleGrid(spacingOf(16), 20).count() == Vec3i{256, 256, 256});
    CHECK(SampleGrid(spacingOf(15), 20).count() == Vec3i{181, 181, 181});
    CHECK(SampleGrid(spacingOf(16, {1, 0.5, 0.1}), 20).count() == Vec3i{256, 128, 26});
    CHECK(SampleGrid(spacingOf(16, {1, 1, 0}), 31).count() == Vec3i{256, 256, 1});
    CHECK(SampleGrid(spacingOf(16, {1, 1e-9, 100}), 31).count() == Vec3i{256, 1, 25600});
    SampleGrid widest(spacingOf(16, {1, 1, 100}), 31);
    const std::uint32_t last = (std::uint32_t{1} << 31) - 1;
    CHECK(widest.cellOf({last, 0, last}) == Vec3i{255, 0, 25599});
    CHECK(widest.indexOf({255, 255, 25599}) == 256ull * 256 * 25600 - 1);

    // In plan, heights do not count.
    Node node(10, 0, {{3, 4, 900}, {4, 3, 1}, {2, 2, 500}, {1000, 1000, 7}});
    std::vector<std::size_t> chosen = node.choose(Sampling::grid, spacingOf(4, {1, 1, 0}));
    CHECK(chosen.size() == 2);
}

TEST_CASE("random takes as many points as grid, wherever points are", "[sample]") {
    Node node(20, 0, randomPoints(20000, 20, 3));
    for (int density : {6, 9, 12}) {
        auto random = node.choose(Sampling::random, spacingOf(density));
        CHECK(random.size() == node.choose(Sampling::grid, spacingOf(density)).size());
        // In Morton order the first half holds about as many as the second: within 5 deviations.
        auto half = static_cast<double>(
            std::count_if(random.begin(), random.end(), [](std::size_t i) { return i < 10000; }));
        auto count = static_cast<double>(random.size());
        CHECK(std::abs(half - count / 2) < 5 * std::sqrt(count / 4));
    }
}

TEST_CASE("what random takes on one level says nothing of the next", "[sample]") {
    std::vector<Vec3i> points = randomPoints(20000, 20, 4);
    Node a(20, 0, points), b(20, 1, points);
    auto fromA = a.choose(Sampling::random, spacingOf(11)), fromB = b.choose(Sampling::random, spacingOf(11));
    REQUIRE(fromA.size() == fromB.size());
    std::vector<std::size_t> both;
    std::set_intersection(fromA.begin(), fromA.end(), fromB.begin(), fromB.end(), std::back_inserter(both));
    double share = static_cast<double>(fromA.size()) / 20000, expected = 20000 * share * share;
    REQUIRE(share > 0.1);
    REQUIRE(share < 0.9);
    CHECK(std::abs(static_cast<double>(both.size()) - expected) < 5 * std::sqrt(expected));
}

TEST_CASE("of points at one position each method takes one, of none none", "[sample]") {
    Node node(12, 0, std::vector<Vec3i>(500, Vec3i{17, 1000, 5}));
    for (Sampling sampling : allSamplings)
        CHECK(node.choose(sampling, spacingOf(16)).size() == 1);
    node.candidates = {};
    for (Sampling sampling : allSamplings)
        CHECK(node.choose(sampling, spacingOf(16)).empty());
}

TEST_CASE("every method keeps every point, and the file says which it was", "[sample]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(3, 150000, 21), folder / "in.las");
    for (Sampling sampling : allSamplings) {
        INFO(samplingNames[static_cast<std::size_t>(sampling)]);
        ConvertOptions options;
        options.sampling = sampling;
        ConvertResult result = convertOrFail({folder / "in.las"}, folder / "c.stipple", options);
        CHECK(result.metadata.options.find(
                  cat("sampling=", samplingNames[static_cast<std::size_t>(sampling)], " ")) == 0);
        auto report = verifyFile(folder / "c.stipple", {folder / "in.las"}, {.threads = 2}, noProgress);
        REQUIRE(report.ok());
        INFO((report->faults.empty() ? "" : report->faults[0]));
        CHECK(report->passed());
        REQUIRE(report->comparison);
        CHECK(report->comparison->equalPoints == 150000);
        CHECK((report->spacedPoints > 0) == (sampling == Sampling::poisson));
        auto source = openFileSource(folder / "c.stipple");
        REQUIRE(source.ok());
        auto reader = CloudReader::open(**source);
        REQUIRE(reader.ok());
        CHECK((*reader)->metadata().sampling == sampling);
    }
}

TEST_CASE("every method gives the same bytes for any threads, memory and order of inputs", "[sample]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(1, 100000, 22), b = surfaceScan(1, 60000, 23);
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    for (Sampling sampling : allSamplings) {
        INFO(samplingNames[static_cast<std::size_t>(sampling)]);
        ConvertOptions options;
        options.sampling = sampling;
        options.name = "c";
        options.threads = 1;
        convertOrFail({folder / "a.las", folder / "b.las"}, folder / "one.stipple", options);
        options.threads = 3;
        options.memoryBytes = 1 << 22; // most points wait on disk
        ConvertResult other =
            convertOrFail({folder / "b.las", folder / "a.las"}, folder / "other.stipple", options);
        CHECK(other.temporaryBytes > 0);
        CHECK(fileBytes(folder / "one.stipple") == fileBytes(folder / "other.stipple"));
    }
}

TEST_CASE("no two points of an inner node share a cell of its grid", "[sample]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 400000, 24), folder / "in.las");
    ConvertOptions options;
    options.sampling = Sampling::grid;
    convertOrFail({folder / "in.las"}, folder / "c.stipple", options);
    auto source = openFileSource(folder / "c.stipple");
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    const CloudMetadata& metadata = (*reader)->metadata();
    double cells = std::ldexp(metadata.grid.scale.x, metadata.rootCube.bits) / metadata.spacing;
    Spacing spacing = spacingOf(static_cast<int>(std::lround(2 * std::log2(cells))));
    std::size_t innerNodes = 0;
    REQUIRE((*reader)
                ->visitNodes([&](const NodeEntry& entry) -> Status {
                    if (entry.childMask == 0)
                        return {};
                    ++innerNodes;
                    STIPPLE_TRY(batch, (*reader)->readNode(entry));
                    SampleGrid grid(spacing, metadata.rootCube.nodeBits(entry.key.level));
                    std::set<std::uint64_t> taken;
                    for (Vec3i p : batch.positions) {
                        Vec3i in = p - metadata.rootCube.nodeMin(entry.key);
                        taken.insert(grid.indexOf(
                            grid.cellOf({static_cast<std::uint32_t>(in.x), static_cast<std::uint32_t>(in.y),
                                         static_cast<std::uint32_t>(in.z)})));
                    }
                    CHECK(taken.size() == batch.positions.size());
                    return {};
                })
                .ok());
    CHECK(innerNodes > 1);
}
