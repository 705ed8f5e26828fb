// Adding scans to a cloud, and refusing points that can't be kept.
#include "test_scan.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
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

namespace {
Error refusalOf(const std::vector<std::string>& inputs, const std::string& output,
                const ConvertOptions& options) {
    auto result = convertFiles(inputs, output, options, noProgress);
    REQUIRE(!result.ok());
    return result.error();
}
bool says(const Error& error, const std::string& part) {
    return error.sentence().find(part) != std::string::npos;
}
ConvertOptions appendTo(const std::string& cloud) {
    ConvertOptions options;
    options.append = cloud;
    return options;
}
} // namespace

TEST_CASE("nothing is added to what is no cloud, which is said of it and not of the output", "[append]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    writeScan(surfaceScan(0, 100, 2), folder / "b.las");
    std::ofstream(folder / "empty.stipple");
    std::filesystem::create_directory(folder / "folder");
    for (const char* name : {"b.las", "empty.stipple", "folder"})
        for (const char* output : {name, "c.stipple"}) {
            Error error = refusalOf({folder / "a.las"}, folder / output, appendTo(folder / name));
            CHECK(error.code == ErrorCode::unsupported);
            CHECK(error.where == folder / name);
            CHECK(says(error, "nothing can be added to it"));
        }
    Error absent = refusalOf({folder / "a.las"}, folder / "none.stipple", appendTo(folder / "none.stipple"));
    CHECK(absent.code == ErrorCode::notFound);
    CHECK(absent.where == folder / "none.stipple");
    CHECK(!std::filesystem::exists(folder / "c.stipple"));
    CHECK(!std::filesystem::exists(folder / "none.stipple"));
}

TEST_CASE("points that a cloud holds are not added again under any name", "[append]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(3, 1000, 1);
    a.grid = {{0.001, 0.001, 0.001}, {0, 0, 0}}; // other integers in the cloud than in the file
    writeScan(a, folder / "a.las");
    writeScan(surfaceScan(3, 1000, 2), folder / "b.las");
    writeScan(surfaceScan(3, 1000, 3), folder / "c.las");
    convertOrFail({folder / "a.las", folder / "b.las"}, folder / "ab.stipple");
    convertOrFail({folder / "b.las"}, folder / "b.stipple");
    std::filesystem::create_directory(folder / "other");
    std::filesystem::copy_file(folder / "a.las", folder / "renamed.las");
    std::filesystem::copy_file(folder / "ab.stipple", folder / "copy.stipple");
    std::filesystem::copy_file(folder / "c.las", folder / "other/a.las");
    Bytes before = fileBytes(folder / "ab.stipple");
    ConvertOptions options = appendTo(folder / "ab.stipple");
    for (const char* input : {"a.las", "renamed.las", "b.stipple", "copy.stipple"}) {
        INFO(input);
        Error error = refusalOf({folder / input}, folder / "ab.stipple", options);
        CHECK(error.code == ErrorCode::invalidArgument);
        CHECK(error.where == folder / input);
        CHECK(says(error, "are in " + (folder / "ab.stipple") + " already"));
        CHECK(says(error, "--allow-duplicates"));
    }
    CHECK(says(refusalOf({folder / "renamed.las"}, folder / "x.stipple", options), "as a.las"));
    CHECK(says(refusalOf({folder / "ab.stipple"}, folder / "x.stipple", options), "to itself"));
    CHECK(says(refusalOf({folder / "renamed.las", folder / "ab.stipple"}, folder / "x.stipple", {}),
               "its points are in"));
    CHECK(fileBytes(folder / "ab.stipple") == before);
    // Other points under a name that is known, in a file of the same size.
    CHECK(convertOrFail({folder / "other/a.las"}, folder / "x.stipple", options).metadata.pointCount == 3000);
    options.allowDuplicates = true;
    CHECK(convertOrFail({folder / "renamed.las"}, folder / "x.stipple", options).metadata.pointCount == 3000);
    // What was added is known from then on.
    options.allowDuplicates = false;
    convertOrFail({folder / "other/a.las"}, folder / "ab.stipple", options);
    CHECK(says(refusalOf({folder / "c.las"}, folder / "ab.stipple", options), "as a.las"));
}

TEST_CASE("an input that is given by two of its names is refused", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    std::filesystem::create_hard_link(folder / "a.las", folder / "hard.las");
    std::filesystem::create_symlink(folder / "a.las", folder / "soft.las");
    for (const char* name : {"a.las", "hard.las", "soft.las", "./a.las"}) {
        Error error = refusalOf({folder / "a.las", folder / name}, folder / "x.stipple", {});
        CHECK(error.code == ErrorCode::invalidArgument);
        CHECK(says(error, "given twice"));
    }
    // A copy is another file; its points are wanted, or not.
    std::filesystem::copy_file(folder / "a.las", folder / "copy.las");
    ConvertResult result = convertOrFail({folder / "a.las", folder / "copy.las"}, folder / "x.stipple");
    CHECK(result.metadata.pointCount == 200);
    CHECK(std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
        return warning.find("the same points as") != std::string::npos;
    }));
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
