// A real scan and a simulated town, converted: what a session's scan reads of a region, and the file made of
// it, against every point of the scan tested one by one, and against the export of the same region.
#include "client/region/region_work.hpp"

#include "converter/build/convert.hpp"
#include "converter/export/export_file.hpp"
#include "converter/synth/synthesize.hpp"
#include "shared/geometry/oriented_box.hpp"
#include "shared/io/file_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/select/region_json.hpp"
#include "tests/support/data.hpp"
#include "tests/support/region_points.hpp"
#include "tests/support/temporary_folder.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

using namespace stipple;
using namespace stipple::test;
using nlohmann::json;

namespace {

struct LasPoints {
    Grid grid;
    Schema schema;
    PointBatch points;
};
LasPoints readLas(const std::string& path) {
    auto source = openFileSource(path);
    REQUIRE(source.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    LasPoints las{(*reader)->header().grid, (*reader)->schema(), {}};
    REQUIRE((*reader)->read(0, (*reader)->pointCount(), las.points).ok());
    return las;
}

// The integers of the points that lie in the region, sorted; `grid`: those that they are to count in.
using Place = std::array<std::int64_t, 3>;
std::vector<Place> placesIn(const LasPoints& las, const std::function<bool(Vec3d)>& holds) {
    std::vector<Place> places;
    for (Vec3i p : las.points.positions)
        if (holds(las.grid.toWorld(p)))
            places.push_back({p.x, p.y, p.z});
    std::sort(places.begin(), places.end());
    return places;
}

std::string asCloud(const std::string& scan, const TemporaryFolder& folder) {
    std::string cloud = folder.file("cloud.stipple");
    auto converted = convertFiles({scan}, cloud, {}, [](const std::string&, std::uint64_t, std::uint64_t) {});
    if (!converted.ok())
        FAIL(converted.error().sentence());
    return cloud;
}

// A scan of the session over the cloud's file, its points made into a LAS file.
LasPoints made(const std::string& cloud, const json& region, const TemporaryFolder& folder,
               RegionProgress& progress) {
    auto decoder = makeInlineDecoder();
    auto session = ViewSession::create(*decoder);
    auto source = openFileSource(cloud);
    REQUIRE(source.ok());
    CloudId id = session->addCloud(std::move(*source), "cloud");
    while (session->clouds()[0].stage == CloudStage::opening)
        session->update(std::chrono::milliseconds(20));
    auto metadata = session->clouds()[0].metadata;
    REQUIRE(metadata);
    auto work = RegionWork::make(metadata, {{"make", "file"}, {"format", "las"}, {"region", region}});
    REQUIRE(work.ok());
    auto filter = regionFromJson((*work)->scan()["region"], "region");
    REQUIRE(filter.ok());
    auto scan = session->scanRegion({id, *filter, (*work)->scan()["attributes"].get<std::vector<int>>()});
    REQUIRE(scan.ok());
    Bytes file;
    auto takePiece = [&] {
        Bytes piece = (*work)->pieces().take();
        file.insert(file.end(), piece.begin(), piece.end());
    };
    for (progress = session->regionProgress(*scan); !progress.complete;
         progress = session->regionProgress(*scan)) {
        REQUIRE_FALSE(progress.error);
        session->update(std::chrono::milliseconds(20));
        for (RegionNode& node : session->takeRegionNodes(*scan, 3)) {
            Status taken = (*work)->take(std::move(node.node), node.tested);
            if (!taken.ok())
                FAIL(taken.error().sentence());
            takePiece();
        }
    }
    REQUIRE((*work)->finish().ok());
    takePiece();
    for (const auto& [offset, bytes] : (*work)->pieces().patches)
        std::copy(bytes.begin(), bytes.end(), file.begin() + static_cast<std::ptrdiff_t>(offset));
    writeText(folder.file("made.las"), std::string(file.begin(), file.end()));
    return readLas(folder.file("made.las"));
}

std::vector<PointRow> rowsOf(const LasPoints& las) {
    std::vector<PointRow> rows;
    addRows(las.points, rows);
    std::sort(rows.begin(), rows.end());
    return rows;
}

// A turned box, a footprint with heights and a corridor in the middle of the scan.
void compareRegions(const std::string& scan) {
    TemporaryFolder folder;
    LasPoints las = readLas(scan);
    std::string cloud = asCloud(scan, folder);
    BoxD bounds;
    for (Vec3i p : las.points.positions)
        bounds.extend(las.grid.toWorld(p));
    Vec3d size = bounds.max - bounds.min, middle = bounds.min + size * 0.47;
    auto whole = placesIn(las, [](Vec3d) { return true; });
    for (int turned = 0; turned < 2; ++turned) {
        BoxAxes axes = axesTurned(turned ? 33 : 0);
        Vec3d half{size.x * 0.21, size.y * 0.13, size.z * 0.4};
        json axesJson = json::array();
        for (const Vec3d& axis : axes)
            axesJson.push_back({axis.x, axis.y, axis.z});
        json region{{"box",
                     {{"centre", {middle.x, middle.y, middle.z}},
                      {"halfSize", {half.x, half.y, half.z}},
                      {"axes", axesJson}}}};
        RegionProgress progress;
        LasPoints found = made(cloud, region, folder, progress);
        auto expected = placesIn(las, [&](Vec3d p) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                if (std::abs(dot(p - middle, axes[axis])) > half[static_cast<int>(axis)])
                    return false;
            return true;
        });
        CHECK(found.grid.scale == las.grid.scale);
        auto places = placesIn(found, [](Vec3d) { return true; });
        INFO(scan << ", " << expected.size() << " of " << whole.size() << " points");
        CHECK(expected.size() > 1000);
        CHECK(expected.size() < whole.size() / 2);
        CHECK(progress.nodesOutside > 0);
        REQUIRE(places.size() == expected.size());
        CHECK(places == expected);
        // The export of the same box: the same points with the same attributes.
        ExportOptions options;
        options.filter.convex = regionFromJson(region, "region")->convex;
        auto exported = exportFile(cloud, folder.file("exported.las"), options,
                                   [](const std::string&, std::uint64_t, std::uint64_t) {});
        REQUIRE(exported.ok());
        LasPoints reference = readLas(folder.file("exported.las"));
        CHECK(reference.schema == found.schema);
        CHECK(reference.grid == found.grid);
        CHECK(rowsOf(reference) == rowsOf(found));
    }
    std::vector<Point2d> ring{{middle.x - size.x * 0.2, middle.y - size.y * 0.2},
                              {middle.x + size.x * 0.3, middle.y - size.y * 0.1},
                              {middle.x, middle.y},
                              {middle.x + size.x * 0.2, middle.y + size.y * 0.3}};
    Ring polygon(ring);
    json corners = json::array();
    for (Point2d corner : ring)
        corners.push_back({corner.x, corner.y});
    double low = bounds.min.z + size.z * 0.02, high = bounds.min.z + size.z * 0.5;
    RegionProgress progress;
    LasPoints found = made(cloud, {{"polygon", corners}, {"heights", {low, high}}}, folder, progress);
    auto expected = placesIn(las, [&](Vec3d p) {
        return p.z >= low && p.z <= high && polygon.sideOf({p.x, p.y}) != Ring::Side::outside;
    });
    CHECK(expected.size() > 1000);
    CHECK(placesIn(found, [](Vec3d) { return true; }) == expected);
}

} // namespace

TEST_CASE("regions of a simulated town are those of its scan") {
    TemporaryFolder folder;
    synth::SynthOptions options;
    options.points = 400'000;
    auto made = synth::synthesize(folder.file("town.las"), options, [](std::uint64_t, std::uint64_t) {});
    REQUIRE(made.ok());
    compareRegions(folder.file("town.las"));
}

TEST_CASE("regions of a real scan are those of its file") {
    STIPPLE_NEEDS_DATA();
    compareRegions(dataPath("clouds/lone-star.laz"));
}
