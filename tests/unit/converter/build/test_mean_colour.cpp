#include "converter/build/sample.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/point_hash.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <cmath>
#include <numeric>

using namespace stipple;
using namespace stipple::test;

namespace {

// Points with colours, sorted, in a node.
struct ColouredTree {
    Schema schema = las::schemaOf(2);
    RowLayout layout;
    RootCube cube;
    SubtreeBuffers buffers;
    std::unique_ptr<Subtree> subtree;
    std::array<int, 3> rgb{schema.find("Red"), schema.find("Green"), schema.find("Blue")};
    ColourRows colours;

    // All three channels of a point are its value.
    ColouredTree(int bits, NodeKey key, const std::vector<Vec3i>& positions,
                 const std::vector<std::uint16_t>& values) {
        cube.bits = bits;
        layout = RowLayout(schema, BoxI{{0, 0, 0}, Vec3i{1, 1, 1} * ((std::int64_t{1} << bits) - 1)});
        colours = ColourRows(layout, rgb);
        PointBatch batch;
        batch.resize(schema, positions.size());
        batch.positions = positions;
        for (std::size_t i = 0; i < values.size(); ++i)
            for (int channel : rgb)
                batch.setValue<std::uint16_t>(channel, i, values[i]);
        std::vector<std::uint32_t> all(positions.size());
        std::iota(all.begin(), all.end(), 0u);
        layout.pack(batch, all, buffers.rows(all.size(), layout.rowBytes()));
        const std::size_t part = all.size();
        subtree = std::make_unique<Subtree>(layout, cube, key, buffers, std::span(&part, 1));
    }
    Candidates candidatesOf(std::size_t node) const {
        Candidates candidates;
        candidates.node = node;
        for (std::uint32_t rank = subtree->nodes()[node].first; rank < subtree->nodes()[node].end(); ++rank) {
            Vec3i p = subtree->position(rank) - cube.nodeMin(subtree->nodes()[node].key);
            candidates.ranks.push_back(rank);
            candidates.positions.push_back({static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                            static_cast<std::uint32_t>(p.z)});
        }
        return candidates;
    }
};

using Values = std::vector<std::uint16_t>;
using Ranks = std::vector<std::uint32_t>;

Values grey(std::initializer_list<int> values) {
    Values result;
    for (int value : values)
        result.insert(result.end(), 3, static_cast<std::uint16_t>(value));
    return result;
}

Spacing spacingOf(int density) {
    Spacing spacing;
    spacing.density = density;
    return spacing;
}

struct Scattered {
    std::vector<Vec3i> positions;
    Values values;
};
Scattered scattered(std::size_t count, int bits, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const std::uint64_t side = std::uint64_t{1} << bits;
    Scattered result;
    for (std::size_t i = 0; i < count; ++i) {
        result.positions.push_back({static_cast<std::int64_t>(random() % side),
                                    static_cast<std::int64_t>(random() % side),
                                    static_cast<std::int64_t>(random() % (side / 16))});
        result.values.push_back(static_cast<std::uint16_t>(random()));
    }
    return result;
}

// A scan of format 2 whose points have the colour of their place.
template <class ColourAt>
TestScan colouredScan(std::size_t count, std::uint64_t seed, ColourAt colourAt) {
    TestScan scan = surfaceScan(2, count, seed);
    for (std::size_t i = 0; i < count; ++i)
        for (const char* name : {"Red", "Green", "Blue"})
            scan.points.setValue<std::uint16_t>(scan.schema.find(name), i,
                                                colourAt(scan.points.positions[i]));
    return scan;
}

ConvertOptions inPieces(int threads = 2, std::uint64_t memoryBytes = 0) {
    ConvertOptions options;
    options.name = "cloud";
    options.threads = threads;
    options.memoryBytes = memoryBytes;
    options.sizes = {.pointsPerRound = 50000, .subtreeBytes = std::uint64_t{1} << 21};
    return options;
}

// Calls visit(entry, whether it has children, what it shows, its exact points) for each node with points.
template <class Visit>
void visitPictures(const std::string& path, Visit visit) {
    auto source = openFileSource(path);
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    Status visited = (*reader)->visitNodes([&](const NodeEntry& entry) -> Status {
        if (entry.pointCount == 0)
            return {};
        STIPPLE_TRY(strata, readNow(**source, entry.strataRange(strataCount)));
        STIPPLE_TRY(picture, decodePicture((*reader)->metadata(), entry, strataCount, strata));
        STIPPLE_TRY(points, (*reader)->readNode(entry));
        visit(entry, picture, points);
        return {};
    });
    REQUIRE(visited.ok());
}

} // namespace

TEST_CASE("a point shows the mean of those it represents, rounded, and leaves show their own", "[colour]") {
    ColouredTree tree(4, {}, {{0, 0, 0}, {1, 0, 0}, {14, 0, 0}, {15, 0, 0}}, {10, 20, 30, 41});
    tree.subtree->splitTo({NodeKey{1, 0, 0, 0}, NodeKey{1, 1, 0, 0}});
    const Spacing spacing = spacingOf(2);
    MeanColours means(*tree.subtree, tree.colours, spacing);
    means.handOn(0, tree.candidatesOf(0), Ranks{0, 0, 3, 3});
    auto shown = means.takeShown();
    REQUIRE(shown.size() == 3);
    CHECK(shown[0] == grey({15, 36}));
    CHECK(shown[1].empty());
    CHECK(shown[2].empty());
}

TEST_CASE("a point that stays on a level shows its area there, and hands all of it on", "[colour]") {
    // Four leaves in a row below two nodes: 0 and 15 come up to the root.
    ColouredTree tree(4, {}, {{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {6, 0, 0}, {9, 0, 0}, {15, 0, 0}},
                      {0, 10, 40, 50, 7, 9});
    tree.subtree->splitTo(
        {NodeKey{2, 0, 0, 0}, NodeKey{2, 1, 0, 0}, NodeKey{2, 2, 0, 0}, NodeKey{2, 3, 0, 0}});
    const Spacing spacing = spacingOf(2);
    MeanColours means(*tree.subtree, tree.colours, spacing);
    REQUIRE(tree.subtree->nodes().size() == 7);
    means.handOn(1, tree.candidatesOf(1), Ranks{0, 0, 2, 2});
    means.handOn(2, tree.candidatesOf(2), Ranks{0, 1});
    Candidates atRoot = tree.candidatesOf(0);
    atRoot.ranks = {0, 2, 4, 5};
    std::vector<Vec3<std::uint32_t>> positions;
    for (std::uint32_t rank : atRoot.ranks)
        positions.push_back(atRoot.positions[rank]);
    atRoot.positions = positions;
    means.handOn(0, atRoot, Ranks{0, 0, 3, 3});
    auto shown = means.takeShown();
    CHECK(shown[0] == grey({25, 8})); // (0 + 10 + 40 + 50) / 4, (7 + 9) / 2
    CHECK(shown[1] == grey({45}));    // the point at 5: 40 and 50
    CHECK(shown[2].empty());          // one that stands for itself alone
    for (std::size_t leaf = 3; leaf < 7; ++leaf)
        CHECK(shown[leaf].empty());
}

TEST_CASE("who is represented outside hands on to the nearest in order, if it is near", "[colour]") {
    ColouredTree tree(6, {}, {{0, 0, 0}, {3, 0, 0}, {40, 0, 0}, {60, 0, 0}}, {10, 20, 30, 50});
    tree.subtree->splitTo({NodeKey{1, 0, 0, 0}, NodeKey{1, 1, 0, 0}});
    const Spacing spacing = spacingOf(8); // 4 steps
    MeanColours means(*tree.subtree, tree.colours, spacing);
    means.handOn(0, tree.candidatesOf(0), Ranks{nobody, 1, nobody, 3});
    CHECK(means.takeShown()[0] == grey({15, 50}));
}

TEST_CASE("sums come up to the root of a subtree, and start anew from its rows", "[colour]") {
    auto [positions, values] = scattered(30000, 12, 1);
    NodeKey key{1, 0, 0, 0};
    ColouredTree tree(13, key, positions, values);
    tree.subtree->splitByCount(1000);
    for (Sampling sampling : {Sampling::poisson, Sampling::grid}) {
        auto sampled = sample(sampling, *tree.subtree, spacingOf(14), tree.colours, {}, 2, nullptr);
        REQUIRE(sampled.ok());
        REQUIRE(sampled->rootSums.size() == sampled->kept[0].size());
        CHECK(sampled->kept[0].size() > 1000);
        ColourSum all;
        for (const ColourSum& sum : sampled->rootSums)
            all.add(sum);
        // Where all near points are chosen in other nodes, the area is theirs.
        CHECK(all.points <= positions.size());
        CHECK(all.points >= positions.size() - (sampling == Sampling::grid ? 0 : 30));
        std::uint64_t expected = std::accumulate(values.begin(), values.end(), std::uint64_t{0});
        if (all.points == positions.size())
            CHECK(all.channels == std::array<std::uint64_t, 3>{expected, expected, expected});
        std::size_t averaged = 0;
        for (std::size_t node = 1; node < tree.subtree->nodes().size(); ++node) {
            if (sampled->shown[node].empty()) // a leaf's, or all stand for themselves
                continue;
            ++averaged;
            CHECK_FALSE(tree.subtree->nodes()[node].isLeaf);
            CHECK(sampled->shown[node].size() == 3 * sampled->kept[node].size());
        }
        CHECK(averaged >= 4);
    }
    ColourSum written{{7, 1ull << 40, 9}, 1ull << 33};
    RowLayout withSums = tree.layout.withExtra(tree.colours.sumBytes());
    Bytes row(withSums.rowBytes());
    std::memcpy(row.data(), tree.subtree->row(5), tree.layout.rowBytes());
    ColourSum own = tree.colours.sumOf(withSums, row.data());
    CHECK(own.points == 1);
    CHECK(own.channels == tree.colours.ownSum(tree.subtree->row(5)).channels);
    tree.colours.writeSum(written, row.data() + tree.layout.rowBytes());
    ColourSum read = tree.colours.sumOf(withSums, row.data());
    CHECK(read.points == written.points);
    CHECK(read.channels == written.channels);
}

TEST_CASE("what is sampled does not depend on whether there are colours to average", "[colour]") {
    auto [positions, values] = scattered(20000, 12, 2);
    ColouredTree tree(12, {}, positions, values);
    tree.subtree->splitByCount(1000);
    for (Sampling sampling : {Sampling::poisson, Sampling::random, Sampling::grid}) {
        auto with = sample(sampling, *tree.subtree, spacingOf(12), tree.colours, {}, 1, nullptr),
             without = sample(sampling, *tree.subtree, spacingOf(12), ColourRows(), {}, 3, nullptr);
        REQUIRE(with.ok());
        REQUIRE(without.ok());
        CHECK(with->kept == without->kept);
        CHECK(without->shown.empty());
    }
}

TEST_CASE("areas of one colour show it on every level, through all tiers", "[colour]") {
    TemporaryFolder folder;
    auto colourAt = [](Vec3i p) { return static_cast<std::uint16_t>(p.x < 30000 ? 17 : 201); };
    writeScan(colouredScan(200000, 21, colourAt), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple", inPieces());
    std::size_t far = 0, wrong = 0, mixed = 0;
    visitPictures(folder / "c.stipple",
                  [&](const NodeEntry&, const NodePicture& picture, const PointBatch& points) {
                      for (std::size_t i = 0; i < picture.size(); ++i) {
                          std::int64_t x = points.positions[i].x;
                          std::uint16_t shown = picture.colour[3 * i];
                          mixed += shown != 17 && shown != 201 ? 1 : 0;
                          if (std::abs(x - 30000) < 2500)
                              continue;
                          ++far;
                          wrong += shown != colourAt(points.positions[i]) ? 1 : 0;
                      }
                  });
    CHECK(far > 100000);
    CHECK(wrong == 0);
    CHECK(mixed > 0);
}

TEST_CASE("coarse nodes of noise show little of it, leaves all; the points keep theirs", "[colour]") {
    TemporaryFolder folder;
    std::mt19937_64 random(5);
    TestScan scan =
        colouredScan(200000, 22, [&](Vec3i) { return static_cast<std::uint16_t>(random() % 256); });
    writeScan(scan, folder / "in.las");
    ConvertResult result = convertOrFail({folder / "in.las"}, folder / "c.stipple", inPieces());
    CHECK(result.metadata.innerColour == InnerColour::mean);
    PointHash hash;
    visitPictures(folder / "c.stipple",
                  [&](const NodeEntry& entry, const NodePicture& picture, const PointBatch& points) {
                      hash.add(scan.schema, points);
                      double squares = 0;
                      for (std::size_t i = 0; i < picture.size(); ++i)
                          squares += std::pow(picture.colour[3 * i] - 127.5, 2);
                      double deviation = std::sqrt(squares / static_cast<double>(picture.size()));
                      if (entry.key.level == 0) {
                          // Each stands for 200,000 / n points: the deviation of one is 73.9.
                          double expected = 73.9 / std::sqrt(200000.0 / entry.pointCount);
                          CHECK(deviation < 1.5 * expected);
                          CHECK(deviation < 45);
                      }
                      if (entry.childMask == 0) {
                          CHECK(entry.attributeBytes[0] == 0);
                          if (entry.pointCount > 1000)
                              CHECK(deviation > 65);
                      }
                  });
    CHECK(hash.hex() == result.metadata.pointHash);
}

TEST_CASE("mean colours are the same for any threads, memory and order of inputs", "[colour]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(2, 90000, 23), folder / "a.las");
    writeScan(surfaceScan(2, 70000, 24), folder / "b.las");
    std::vector<std::string> inputs{folder / "a.las", folder / "b.las"}, turned{inputs[1], inputs[0]};
    convertOrFail(inputs, folder / "one.stipple", inPieces(1));
    Bytes first = fileBytes(folder / "one.stipple");
    for (int threads : {2, 3}) {
        convertOrFail(turned, folder / "other.stipple", inPieces(threads, threads == 2 ? 1 : 0));
        CHECK((fileBytes(folder / "other.stipple") == first)); // not printed
    }
    // A cloud that is added to is averaged anew, from its exact colours.
    convertOrFail({inputs[0]}, folder / "part.stipple", inPieces());
    ConvertOptions append = inPieces();
    append.append = folder / "part.stipple";
    convertOrFail({inputs[1]}, folder / "appended.stipple", append);
    CHECK((fileBytes(folder / "appended.stipple") == first));
}

TEST_CASE("leaves show their own colours, also of 16 bits, whatever subtree they are in", "[colour]") {
    TemporaryFolder folder;
    // A small leaf among large subtrees comes to the upper tier as points, a large one as a sample.
    TestScan scan = surfaceScan(2, 200000, 28);
    for (std::size_t i = 0; i < 200; ++i)
        scan.points.positions[i].x += 200000;
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple", inPieces());
    std::size_t leaves = 0, averaged = 0;
    visitPictures(folder / "c.stipple", [&](const NodeEntry& entry, const NodePicture& picture,
                                            const PointBatch& points) {
        if (entry.childMask != 0) {
            averaged += entry.attributeBytes[0] > 0 ? 1 : 0;
            return;
        }
        ++leaves;
        CHECK(entry.attributeBytes[0] == 0);
        bool same = true;
        for (std::size_t i = 0; i < picture.size(); ++i)
            same = same && picture.colour[3 * i] == points.value<std::uint16_t>(scan.schema.find("Red"), i);
        CHECK(same);
    });
    CHECK(leaves > 10);
    CHECK(averaged > 5);
}

TEST_CASE("without an option RGB is averaged, intensity is not", "[colour]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 1000, 26), folder / "intensity.las");
    writeScan(surfaceScan(2, 1000, 27), folder / "rgb.las");
    CHECK(convertOrFail({folder / "intensity.las"}, folder / "c.stipple").metadata.innerColour ==
          InnerColour::exact);
    CHECK(convertOrFail({folder / "rgb.las"}, folder / "c.stipple").metadata.innerColour ==
          InnerColour::mean);
}

TEST_CASE("clouds that show exact colours are of version 1", "[colour]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(2, 100000, 25), folder / "in.las");
    ConvertOptions options;
    for (InnerColour colour : {InnerColour::exact, InnerColour::mean}) {
        options.innerColour = colour;
        ConvertResult result = convertOrFail({folder / "in.las"}, folder / "c.stipple", options);
        CHECK(result.metadata.innerColour == colour);
        CHECK(fileBytes(folder / "c.stipple")[8] == (colour == InnerColour::exact ? 1 : 2));
    }
}
