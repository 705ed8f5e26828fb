// Levels of detail and classes of converted clouds, and how exports end.
#include "shared/base/text.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <cmath>
#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {

// 80,000 points: an inner root and leaves below it.
struct LevelsFixture {
    TemporaryFolder folder;
    std::string cloud = folder / "c.stipple";

    LevelsFixture() : LevelsFixture(Sampling::poisson) {}
    explicit LevelsFixture(Sampling sampling) {
        writeScan(surfaceScan(6, 80000, 1), folder / "in.las");
        ConvertOptions options;
        options.sampling = sampling;
        convertOrFail({folder / "in.las"}, cloud, options);
    }
    void checkSpacings() const;
};

double squaredDistance(const AllPoints& all, std::size_t a, std::size_t b) {
    Vec3i d = all.points.positions[a] - all.points.positions[b];
    Vec3d apart{double(d.x) * 0.01, double(d.y) * 0.01, double(d.z) * 0.01};
    return dot(apart, apart);
}

void LevelsFixture::checkSpacings() const {
    AllPoints all = allPoints(cloud);
    double root = all.metadata.spacing;
    REQUIRE(root > 0);
    int levels = 0;
    for (const NodeEntry& node : all.nodes)
        levels = std::max(levels, node.key.level + 1);
    REQUIRE(levels >= 2);
    for (double spacing : {root * 1.01, root * 7, root / 2, root / 64}) {
        INFO("spacing " << spacing << ", root " << root);
        // By looking at every pair of points of a node whose x are near enough, in stored order.
        std::vector<bool> wanted(all.points.size(), false);
        std::multimap<double, std::size_t> kept; // of the node, by x
        for (std::size_t i = 0; i < all.points.size(); ++i) {
            const NodeEntry& node = all.nodes[i];
            if (i == 0 || node.key != all.nodes[i - 1].key)
                kept.clear();
            double own = root / (1 << node.key.level);
            if (own < spacing && node.key.level > 0)
                continue;
            bool free = true;
            bool thins = node.childMask == 0 || own < spacing || all.metadata.sampling != Sampling::poisson;
            const double x = double(all.points.positions[i].x) * 0.01;
            for (auto k = kept.lower_bound(x - 1.001 * spacing);
                 k != kept.end() && k->first <= x + 1.001 * spacing && thins && free; ++k)
                free = squaredDistance(all, i, k->second) >= spacing * spacing;
            wanted[i] = free;
            if (free)
                kept.emplace(x, i);
        }
        ExportOptions options;
        options.filter.spacing = spacing;
        ExportResult result = exportOrFail(cloud, folder / "out.las", options);
        requireEqual(readLas(folder / "out.las").points,
                     rowsWhere(all, [&](std::size_t i) { return wanted[i]; }));
        CHECK(result.points > 0);
        if (spacing >= root)
            CHECK(result.counters.finer.nodes + 1 >= 4);
        // The level of detail does not depend on where one looks.
        options.filter.box = BoxD{{500100, 4000050, -1e9}, {500300, 4000200, 1e9}};
        exportOrFail(cloud, folder / "part.las", options);
        requireEqual(readLas(folder / "part.las").points, rowsWhere(all, [&](std::size_t i) {
                         return wanted[i] && options.filter.box->contains(all.world(i));
                     }));
    }
}

} // namespace

TEST_CASE_METHOD(LevelsFixture,
                 "a spacing gives the levels that keep it, leaves thinned, and reads no finer node") {
    checkSpacings();
}

TEST_CASE("inner nodes are thinned, too, where they were sampled without a minimum distance") {
    for (Sampling sampling : {Sampling::grid, Sampling::random})
        LevelsFixture(sampling).checkSpacings();
}

TEST_CASE_METHOD(LevelsFixture, "classes choose points, and a class that is nowhere reads no node") {
    AllPoints all = allPoints(cloud);
    int column = all.metadata.schema.find("Classification");
    ExportOptions options;
    options.filter.conditions = {{"Classification", {{2, 2}, {6, 9}, {255, 255}}}};
    options.attributes = {{"Intensity"}};
    ExportResult result = exportOrFail(cloud, folder / "out.las", options);
    PointBatch expected = rowsWhere(all, [&](std::size_t i) {
        auto value = all.points.value<std::uint8_t>(column, i);
        return value == 2 || (value >= 6 && value <= 9) || value == 255;
    });
    LasContent las = readLas(folder / "out.las");
    CHECK(las.points.positions == expected.positions);
    CHECK(
        (las.points.columns[static_cast<std::size_t>(las.schema.find("Intensity"))] == expected.columns[0]));
    CHECK(result.counters.dropped.byAttribute == all.points.size() - expected.size());

    options.filter.conditions = {{"Classification", {{300, 400}}}};
    ExportResult none = exportOrFail(cloud, folder / "none.las", options);
    CHECK(none.points == 0);
    CHECK(none.counters.bytesRead == 0);
    CHECK(none.counters.absent.nodes > 0);
    CHECK(readLas(folder / "none.las").points.size() == 0);
}

TEST_CASE("a part of a cloud too wide for LAS is exported, the whole as CSV") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(0, 10, 1), b = a;
    b.grid.offset.x += 1e8; // 10^10 steps away
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    convertOrFail({folder / "a.las", folder / "b.las"}, folder / "c.stipple");
    ExportOptions options;
    options.filter.box = BoxD{{1e8, 0, -1e9}, {2e8, 1e9, 1e9}};
    CHECK(exportOrFail(folder / "c.stipple", folder / "out.las", options).points == 10);
    CHECK(readLas(folder / "out.las").header.bounds.min.x >= 1e8);
    exportOrFail(folder / "c.stipple", folder / "out.csv");
    CHECK(readCsv(textOf(folder / "out.csv")).rows.size() == 20);
}

TEST_CASE("an empty cloud gives valid empty files") {
    TemporaryFolder folder;
    writeScan(surfaceScan(3, 0, 1), folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    ExportOptions options;
    for (bool filtered : {false, true}) {
        if (filtered)
            options.filter.box = BoxD{{0, 0, 0}, {1, 1, 1}};
        CHECK(exportOrFail(folder / "c.stipple", folder / "out.las", options).points == 0);
        CHECK(readLas(folder / "out.las").points.size() == 0);
        exportOrFail(folder / "c.stipple", folder / "out.laz", options);
        CHECK(readLas(folder / "out.laz").points.size() == 0);
        exportOrFail(folder / "c.stipple", folder / "out.csv", options);
        CHECK(readCsv(textOf(folder / "out.csv")).names.size() > 3);
        exportOrFail(folder / "c.stipple", folder / "out.ply", options);
        CHECK(readPly(textOf(folder / "out.ply")).count == 0);
    }
}

TEST_CASE("a node of very many points is written in parts") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 300000, 1);
    for (Vec3i& p : scan.points.positions)
        p = {1, 2, 3}; // all in one leaf
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    exportOrFail(folder / "c.stipple", folder / "out.las");
    AllPoints all = allPoints(folder / "c.stipple");
    requireEqual(readLas(folder / "out.las").points, all.points);
    ExportOptions options;
    options.filter.spacing = 0.001;
    CHECK(exportOrFail(folder / "c.stipple", folder / "one.las", options).points == 1);
}

TEST_CASE("outputs that can't be are refused, and nothing is written") {
    SmallCloudFile file;
    const TemporaryFolder& folder = file.folder;
    auto errorOf = [&](const std::string& output, const ExportOptions& options = {}) {
        std::size_t before = folder.files();
        auto result = exportFile(file.path, output, options, noProgress);
        REQUIRE_FALSE(result.ok());
        CHECK(folder.files() == before);
        return result.error();
    };
    CHECK(errorOf(folder / "out.xyz").what == "\".xyz\" is no format that can be exported");
    CHECK(errorOf(folder / "out").what == "the output has no extension to tell the format by");
    ExportOptions asLas;
    asLas.format = ExportFormat::las;
    CHECK(errorOf("-").sentence() ==
          "standard output has no extension to tell the format by (give --format las, ply or csv)");
    ExportOptions asLaz;
    asLaz.format = ExportFormat::laz;
    CHECK(errorOf("-", asLaz).what ==
          "a LAZ file can't go to standard output, for its beginning is written last");
    CHECK(errorOf(file.path, asLas).what == "the output is one of the inputs");
    asLas.force = true;
    CHECK(errorOf(file.path, asLas).what == "the output is one of the inputs");
    CHECK(errorOf(folder / "no/where.ply").code == ErrorCode::writeFailed);

    std::ofstream(folder / "notes.csv") << "my,own,table\n1,2,3\n";
    CHECK(errorOf(folder / "notes.csv").what == "the output exists and is a file of another kind");
    CHECK(textOf(folder / "notes.csv") == "my,own,table\n1,2,3\n");
    ExportOptions force;
    force.force = true;
    exportOrFail(file.path, folder / "notes.csv", force);
    exportOrFail(file.path, folder / "notes.csv"); // its own kind needs no force
    CHECK(readCsv(textOf(folder / "notes.csv")).rows.size() == file.cloud.metadata.pointCount);

    ExportOptions unknown;
    unknown.attributes = {{"Intensity,Height"}};
    CHECK(errorOf(folder / "out.csv", unknown).sentence() ==
          "the cloud has no attribute \"Height\" (it has Intensity, Point Source ID, Red, Green, Blue)");
    ExportOptions polygons;
    polygons.polygonFile = folder / "absent.json";
    CHECK(errorOf(folder / "out.csv", polygons).code == ErrorCode::notFound);
    std::ofstream(folder / "bad.json")
        << R"({"type": "Polygon", "coordinates": [[[0,0],[1,0],[1,1],[0,1]]]})";
    polygons.polygonFile = folder / "bad.json";
    CHECK(errorOf(folder / "out.csv", polygons).where == folder / "bad.json" + ", coordinates[0][3]");
}

TEST_CASE("an export that is interrupted, or meets a damaged node, leaves nothing") {
    SmallCloudFile file;
    for (const char* name : {"out.las", "out.laz", "out.ply", "out.csv"}) {
        std::atomic<bool> stop{false};
        ExportOptions options;
        options.stop = &stop;
        options.threads = 2;
        auto result = exportFile(file.path, file.folder / name, options,
                                 [&](const std::string&, std::uint64_t, std::uint64_t) { stop = true; });
        REQUIRE_FALSE(result.ok());
        CHECK(result.error().code == ErrorCode::cancelled);
        CHECK(file.folder.files() == 1);
    }
    Bytes damaged = file.cloud.file;
    const NodeEntry& node = file.cloud.nodes[7];
    damaged[node.offsetBytes + node.sizeBytes() / 2] ^= 1;
    std::ofstream(file.path, std::ios::binary)
        .write(reinterpret_cast<const char*>(damaged.data()), static_cast<std::streamsize>(damaged.size()));
    for (const char* name : {"out.las", "out.laz", "out.ply", "out.csv"}) {
        auto result = exportFile(file.path, file.folder / name, {}, noProgress);
        REQUIRE_FALSE(result.ok());
        CHECK(result.error().where.find(cat(file.path, ", node ", node.key.text())) == 0);
        CHECK(file.folder.files() == 1);
    }
}
