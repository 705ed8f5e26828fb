// Adding scans to a cloud, and refusing points that can't be kept.
#include "test_scan.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>

using namespace stipple;
using namespace stipple::test;

TEST_CASE("a cloud that a scan is added to is the cloud of both scans, byte for byte", "[append]") {
    TemporaryFolder folder;
    for (int format : {2, 3, 7}) {
        writeScan(surfaceScan(format, 90000, 1), folder / "a.las");
        writeScan(surfaceScan(format, 50000, 2), folder / "b.las");
        ConvertOptions options;
        options.name = "cloud";
        convertOrFail({folder / "a.las", folder / "b.las"}, folder / "both.stipple", options);
        convertOrFail({folder / "a.las"}, folder / "a.stipple", options);
        Bytes before = fileBytes(folder / "a.stipple");
        options.append = folder / "a.stipple";
        convertOrFail({folder / "b.las"}, folder / "added.stipple", options);
        CHECK(fileBytes(folder / "a.stipple") == before);
        ConvertResult result = convertOrFail({folder / "b.las"}, folder / "a.stipple", options);
        CHECK(result.metadata.pointCount == 140000);
        CHECK(result.metadata.sources.size() == 2);
        Bytes both = fileBytes(folder / "both.stipple");
        CHECK(fileBytes(folder / "added.stipple") == both);
        CHECK(fileBytes(folder / "a.stipple") == both);
    }
}

TEST_CASE("a scan is not added twice, nor anything to what is no cloud", "[append]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    writeScan(surfaceScan(0, 100, 2), folder / "b.las");
    convertOrFail({folder / "a.las"}, folder / "a.stipple");
    Bytes before = fileBytes(folder / "a.stipple");
    ConvertOptions options;
    options.append = folder / "a.stipple";
    auto twice = convertFiles({folder / "a.las"}, folder / "a.stipple", options, noProgress);
    REQUIRE(!twice.ok());
    CHECK(twice.error().code == ErrorCode::invalidArgument);
    CHECK(twice.error().sentence().find("a.las") != std::string::npos);
    CHECK(fileBytes(folder / "a.stipple") == before);
    options.append = folder / "b.las";
    auto toScan = convertFiles({folder / "a.las"}, folder / "c.stipple", options, noProgress);
    REQUIRE(!toScan.ok());
    CHECK(toScan.error().code == ErrorCode::unsupported);
    options.append = folder / "none.stipple";
    auto toNothing = convertFiles({folder / "a.las"}, folder / "c.stipple", options, noProgress);
    REQUIRE(!toNothing.ok());
    CHECK(toNothing.error().code == ErrorCode::notFound);
    CHECK(!std::filesystem::exists(folder / "c.stipple"));
}

TEST_CASE("points that are no numbers are dropped and counted, or refused when asked to be strict",
          "[convert]") {
    TemporaryFolder folder;
    std::ofstream(folder / "in.ply") << "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\n"
                                        "property double y\nproperty double z\nend_header\n"
                                        "1 2 3\n4 nan 6\n7 8 inf\n1.5 2.5 3.5\n";
    ConvertResult result = convertOrFail({folder / "in.ply"}, folder / "out.stipple");
    CHECK(result.metadata.pointCount == 2);
    CHECK(result.dropped.notFinite == 2);
    bool told = false;
    for (const std::string& warning : result.warnings)
        told = told || warning.find("2 points were dropped") != std::string::npos;
    CHECK(told);
    ConvertOptions strict;
    strict.strict = true;
    auto refused = convertFiles({folder / "in.ply"}, folder / "strict.stipple", strict, noProgress);
    REQUIRE(!refused.ok());
    CHECK(refused.error().sentence().find("2 points were dropped") != std::string::npos);
    CHECK(!std::filesystem::exists(folder / "strict.stipple"));
    CHECK(!std::filesystem::exists(folder / "strict.stipple.work"));
}
