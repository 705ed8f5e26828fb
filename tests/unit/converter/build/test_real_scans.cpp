#include "converter/build/verify.hpp"
#include "converter/export/export_file.hpp"
#include "converter/input/open.hpp"
#include "shared/io/file_source.hpp"
#include "tests/support/data.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>
#include <set>

using namespace stipple;
using namespace stipple::test;

namespace {
std::vector<std::string> filesIn(const std::string& folder) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(dataPath(folder)))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    return files;
}

VerifyReport compare(const std::string& cloud, const std::string& with) {
    auto report = verifyFile(cloud, {with}, {.threads = 2}, noProgress);
    if (!report)
        FAIL(report.error().sentence());
    REQUIRE(report->comparison);
    return std::move(report).value();
}

// Every point of the one in the other once, all attributes of the cloud equal.
void checkSame(const VerifyReport& report, std::uint64_t points) {
    INFO((report.faults.empty() ? "" : report.faults[0]));
    CHECK(report.comparison->same());
    CHECK(report.comparison->equalPoints == points);
    CHECK(report.tooNear == 0);
    CHECK(report.faultCount == 0);
}

// Converts, compares with the scan, exports as LAS and LAZ, and compares with these.
ConvertResult roundTrip(const std::string& scan) {
    INFO(scan);
    TemporaryFolder folder;
    std::string cloud = folder / "c.stipple";
    ConvertResult converted = convertOrFail({scan}, cloud);
    VerifyReport report = compare(cloud, scan);
    checkSame(report, converted.metadata.pointCount);
    for (const char* name : {"out.las", "out.laz"}) {
        INFO(name);
        auto exported = exportFile(cloud, folder / name, {}, noProgress);
        if (!exported)
            FAIL(exported.error().sentence());
        report = compare(cloud, folder / name);
        checkSame(report, converted.metadata.pointCount);
        // Fields that LAS can't leave out are no fault, and no point of a scan in LAS has them for nothing.
        CHECK(report.notes.empty() == converted.metadata.sources[0].format.starts_with("LA"));
    }
    return converted;
}

int pointFormatOf(const std::string& scan) {
    auto source = openFileSource(scan);
    REQUIRE(source.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    return (*reader)->header().pointFormat;
}

// What is wrong with the files that can't be read.
struct Broken {
    const char *file, *says;
};
constexpr Broken brokenFiles[] = {
    {"broken_coder.laz", "coder 15 is not known"},
    {"broken_size.laz", "item 0 (POINT10) has version 6, which is not known"},
    {"broken_version.laz", "item 0 (POINT10) has version 6, which is not known"},
    {"bad-crc.e57", "the checksum of page 0 is 1392E413, but its bytes give 360E223D"},
};
bool isBroken(const std::string& scan) {
    return std::any_of(std::begin(brokenFiles), std::end(brokenFiles),
                       [&](const Broken& broken) { return scan.ends_with(broken.file); });
}
} // namespace

TEST_CASE("real scans of every point format, as LAS and as LAZ, lose nothing", "[real]") {
    STIPPLE_NEEDS_DATA();
    std::set<int> lasFormats, lazFormats;
    for (const std::string& scan : filesIn("las-pairs")) {
        (scan.ends_with(".laz") ? lazFormats : lasFormats).insert(pointFormatOf(scan));
        roundTrip(scan);
    }
    std::set<int> all{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
    CHECK(lasFormats == all);
    CHECK(lazFormats == all);
}

TEST_CASE("a real scan makes the same points of its LAS and its LAZ file", "[real]") {
    STIPPLE_NEEDS_DATA();
    int pairs = 0;
    for (const std::string& laz : filesIn("las-pairs")) {
        if (!laz.ends_with(".laz"))
            continue;
        INFO(laz);
        TemporaryFolder folder;
        ConvertResult converted = convertOrFail({laz}, folder / "c.stipple");
        VerifyReport report =
            compare(folder / "c.stipple", std::filesystem::path(laz).replace_extension(".las").string());
        checkSame(report, converted.metadata.pointCount);
        CHECK(report.passed());
        ++pairs;
    }
    CHECK(pairs >= 15);
}

TEST_CASE("real scans with odd headers lose nothing", "[real]") {
    STIPPLE_NEEDS_DATA();
    for (const std::string& scan : filesIn("las-odd"))
        if (!isBroken(scan))
            roundTrip(scan);
}

TEST_CASE("real scans of other kinds lose nothing", "[real]") {
    STIPPLE_NEEDS_DATA();
    for (const std::string& scan : filesIn("other"))
        if (!isBroken(scan))
            roundTrip(scan);
}

TEST_CASE("the points that a real scan can't give are counted", "[real]") {
    STIPPLE_NEEDS_DATA();
    TemporaryFolder folder;
    std::string scan = dataPath("other/table_scene_mug_stereo_textured.pcd");
    ConvertResult converted = convertOrFail({scan}, folder / "c.stipple");
    CHECK(converted.metadata.pointCount == 209280);
    CHECK(converted.dropped.notFinite == 97920);
    CHECK(converted.dropped.dropped() == 97920);
    ConvertOptions strict;
    strict.strict = true;
    auto refused = convertFiles({scan}, folder / "strict.stipple", strict, noProgress);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().sentence().find("97920") != std::string::npos);
    CHECK(folder.files() == 1);
}

TEST_CASE("real scans that are broken are refused in words", "[real]") {
    STIPPLE_NEEDS_DATA();
    for (const Broken& broken : brokenFiles) {
        INFO(broken.file);
        TemporaryFolder folder;
        std::string kind = std::string(broken.file).ends_with(".e57") ? "other/" : "las-odd/";
        auto result = convertFiles({dataPath(kind + broken.file)}, folder / "c.stipple", {}, noProgress);
        REQUIRE_FALSE(result.ok());
        std::string sentence = result.error().sentence();
        INFO(sentence);
        CHECK(sentence.find(broken.file) != std::string::npos);
        CHECK(sentence.find(broken.says) != std::string::npos);
        CHECK(folder.files() == 0);
    }
}

TEST_CASE("what contradicts itself in real scans is said", "[real]") {
    STIPPLE_NEEDS_DATA();
    struct Odd {
        const char *file, *says;
    };
    for (const Odd& odd : {Odd{"las-odd/bad-geotiff-keys.las", "GeoTIFF key 5 of 8 is empty"},
                           Odd{"las-odd/bad_vlr_count.las", "counts 3 variable length records, but only 2"},
                           Odd{"las-odd/spurious.las", "the points' bounds are used"},
                           Odd{"other/missingheader.pcd", "no header names the columns; taken as x y z"},
                           Odd{"other/bun_zipper.ply", "only the vertices are read"},
                           Odd{"clouds/lone-star.laz", "its system is taken as unknown"}}) {
        INFO(odd.file);
        TemporaryFolder folder;
        ConvertResult converted = convertOrFail({dataPath(odd.file)}, folder / "c.stipple");
        bool said = std::any_of(converted.warnings.begin(), converted.warnings.end(), [&](const auto& text) {
            return text.find(odd.file) != std::string::npos && text.find(odd.says) != std::string::npos;
        });
        CHECK(said);
    }
}

TEST_CASE("real clouds of half a million points lose nothing", "[real]") {
    STIPPLE_NEEDS_DATA();
    for (const char* cloud : {"ign_extra_bytes_pdrf8.laz", "lion_takanawa.copc.laz"})
        roundTrip(dataPath(std::string("clouds/") + cloud));
}

TEST_CASE("real clouds of up to ten million points lose nothing", "[real][slow]") {
    STIPPLE_NEEDS_DATA();
    for (const std::string& cloud : filesIn("clouds"))
        roundTrip(cloud);
}
