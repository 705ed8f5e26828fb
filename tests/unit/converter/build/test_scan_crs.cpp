// One coordinate reference system for all inputs.
#include "converter/build/scan.hpp"
#include "converter/build/verify.hpp"
#include "converter/crs/crs.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
void writeIn(const std::string& crs, const std::string& path,
             Grid grid = {{0.01, 0.01, 0.01}, {500000, 4000000, 0}}) {
    TestScan scan = surfaceScan(6, 200, 1);
    las::WriterOptions options;
    options.grid = grid;
    options.schema = scan.schema;
    options.pointFormat = 6;
    if (!crs.empty())
        options.wkt = crsFromUser(crs)->wkt;
    auto writer = las::Writer::create(path, options);
    REQUIRE(writer.ok());
    REQUIRE((*writer)->write(scan.points).ok());
    REQUIRE((*writer)->finish().ok());
}

Scan scanned(const std::vector<std::string>& paths, const std::string& crs = "") {
    auto scan = scanInputs(paths, {.crs = crs});
    if (!scan)
        FAIL(scan.error().sentence());
    return std::move(*scan);
}

bool mentions(const std::vector<std::string>& sentences, const std::string& part) {
    for (const std::string& sentence : sentences)
        if (sentence.find(part) != std::string::npos)
            return true;
    return false;
}
} // namespace

TEST_CASE("inputs of other systems are named with what --crs would do", "[crs]") {
    TemporaryFolder folder;
    writeIn("EPSG:32610", folder / "a.las");
    writeIn("EPSG:32611", folder / "b.las");
    auto refused = scanInputs({folder / "a.las", folder / "b.las"}, {});
    REQUIRE(!refused.ok());
    std::string sentence = refused.error().sentence();
    for (const char* part :
         {"a.las", "b.las", "EPSG:32610", "EPSG:32611", "--crs EPSG:n brings all inputs into one"}) {
        CAPTURE(sentence, part);
        CHECK(sentence.find(part) != std::string::npos);
    }
}

TEST_CASE("--crs reprojects the inputs of other systems alone, and says how exactly", "[crs]") {
    TemporaryFolder folder;
    writeIn("EPSG:32610", folder / "a.las");
    writeIn("EPSG:32611", folder / "b.las");
    writeIn("EPSG:26911", folder / "c.las");
    writeIn("", folder / "d.las");
    Scan scan =
        scanned({folder / "a.las", folder / "b.las", folder / "c.las", folder / "d.las"}, "EPSG:32610");
    CHECK(scan.crs.epsg == 32610);
    CHECK_FALSE(mentions(scan.warnings, "a.las"));
    CHECK(mentions(scan.warnings,
                   "b.las: reprojected from WGS 84 / UTM zone 11N (EPSG:32611) to WGS 84 / UTM "
                   "zone 10N (EPSG:32610)"));
    CHECK(mentions(scan.warnings,
                   "exact but for rounding; x and y are rounded by at most 0.005 metre; heights are kept"));
    CHECK(mentions(scan.warnings, "c.las: reprojected from NAD83"));
    CHECK(mentions(scan.warnings, " m, as PROJ states"));
    CHECK(mentions(scan.warnings, "d.las: no CRS stated; taken to be WGS 84 / UTM zone 10N"));
    CHECK(scan.inputs[0].description().grid.toWorld({0, 0, 0}).x == 500000);
    // 6 degrees further east at this latitude.
    Vec3d moved = scan.inputs[1].description().grid.toWorld(scan.inputs[1].description().bounds.min);
    CHECK(moved.x > 1e6);
    CHECK(moved.x < 1.1e6);
}

TEST_CASE("inputs of one system are brought into another together, with one sentence", "[crs]") {
    TemporaryFolder folder;
    writeIn("EPSG:32610", folder / "a.las");
    writeIn("EPSG:32610", folder / "b.las", {{0.001, 0.001, 0.001}, {600000, 4000000, 0}});
    Scan scan = scanned({folder / "a.las", folder / "b.las"}, "EPSG:4326");
    CHECK(scan.warnings.size() == 1);
    CHECK(mentions(scan.warnings, "a.las and 1 more input: reprojected"));
    CHECK(scan.grid.scale == Vec3d{1e-9, 1e-9, 0.001});
    for (const ScannedInput& input : scan.inputs)
        CHECK(input.toCloud.isExact());
}

TEST_CASE("systems that differ in their heights alone are two", "[crs]") {
    TemporaryFolder folder;
    writeIn("EPSG:6339+5703", folder / "meters.las");
    writeIn("EPSG:6339+6360", folder / "feet.las");
    writeIn("EPSG:6339", folder / "flat.las");
    CHECK_FALSE(scanInputs({folder / "meters.las", folder / "feet.las"}, {}).ok());
    // Which has no heights of its own takes those of the other.
    CHECK(scanned({folder / "flat.las", folder / "meters.las"}).crs.vertical == "NAVD88 height");
    CHECK(scanned({folder / "meters.las", folder / "flat.las"}).crs.vertical == "NAVD88 height");
    Scan scan = scanned({folder / "feet.las"}, "EPSG:6339+5703");
    CHECK(mentions(scan.warnings, "heights are transformed"));
    CHECK(scan.inputs[0].description().grid.scale.z == 0.001); // 0.01 ft
}

TEST_CASE("a reprojected cloud is verified against its inputs as they are", "[crs]") {
    TemporaryFolder folder;
    writeIn("EPSG:32610", folder / "a.las");
    writeIn("EPSG:32611", folder / "b.las");
    ConvertResult result =
        convertOrFail({folder / "a.las", folder / "b.las"}, folder / "c.stipple", {.crs = "EPSG:3857"});
    CHECK(result.metadata.crs.epsg == 3857);
    auto report =
        verifyFile(folder / "c.stipple", {folder / "b.las", folder / "a.las"}, {.threads = 1}, noProgress);
    REQUIRE(report.ok());
    CHECK(report->passed());
    CHECK(report->comparison->equalPoints == 400);
    convertOrFail({folder / "b.las", folder / "a.las"}, folder / "d.stipple",
                  {.name = "c", .crs = "EPSG:3857"});
    CHECK(fileBytes(folder / "c.stipple") == fileBytes(folder / "d.stipple"));
}
