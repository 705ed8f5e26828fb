#include "server/verbs/view_inputs.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

using namespace stipple;
using namespace stipple::test;
namespace fs = std::filesystem;

namespace {
const std::atomic<bool> never{false};

std::string prepare(const std::string& input) {
    auto path = server::prepareInput(input, never);
    if (!path)
        FAIL(path.error().sentence());
    return *path;
}

std::uint64_t pointsOf(const std::string& cloud) {
    auto source = openFileSource(cloud);
    REQUIRE(source.ok());
    auto reader = CloudReader::open(**source);
    REQUIRE(reader.ok());
    return (*reader)->metadata().pointCount;
}
} // namespace

TEST_CASE("scans of one name and several kinds become different clouds", "[view]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    writeScan(surfaceScan(0, 200, 2), folder / "a.LAS");
    std::ofstream(folder / "a.txt") << "1 2 3\n4 5 6\n";
    std::string las = prepare(folder / "a.las"), other = prepare(folder / "a.LAS"),
                text = prepare(folder / "a.txt");
    CHECK(las == folder / "a.stipple");
    CHECK(other == folder / "a.LAS.stipple");
    CHECK(text == folder / "a.txt.stipple");
    CHECK(pointsOf(las) == 100);
    CHECK(pointsOf(other) == 200);
    CHECK(pointsOf(text) == 2);
    // Each finds its own again, in any order.
    auto written = fs::last_write_time(other);
    CHECK(prepare(folder / "a.txt") == text);
    CHECK(prepare(folder / "a.LAS") == other);
    CHECK(prepare(folder / "a.las") == las);
    CHECK(fs::last_write_time(other) == written);
    CHECK(folder.files() == 6);
}

TEST_CASE("a scan that changed is converted again, in place", "[view]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    std::string cloud = prepare(folder / "a.las");
    auto written = fs::last_write_time(cloud);
    // Its time says nothing, as after a copy that kept the time; its size does.
    writeScan(surfaceScan(0, 150, 1), folder / "a.las");
    fs::last_write_time(folder / "a.las", written - std::chrono::hours(1));
    CHECK(prepare(folder / "a.las") == cloud);
    CHECK(pointsOf(cloud) == 150);
    // Of the same size, but newer.
    writeScan(surfaceScan(0, 150, 2), folder / "a.las");
    fs::last_write_time(folder / "a.las", fs::last_write_time(cloud) + std::chrono::hours(1));
    Bytes before = fileBytes(cloud);
    CHECK(prepare(folder / "a.las") == cloud);
    CHECK_FALSE((fileBytes(cloud) == before));
}

TEST_CASE("a cloud of several scans is not replaced by that of one", "[view]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "town.las");
    writeScan(surfaceScan(0, 100, 2), folder / "b.las");
    convertOrFail({folder / "town.las", folder / "b.las"}, folder / "town.stipple");
    CHECK(prepare(folder / "town.las") == folder / "town.las.stipple");
    CHECK(pointsOf(folder / "town.stipple") == 200);
}

TEST_CASE("clouds and folders are served as they are, told by content", "[view]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "a.las");
    convertOrFail({folder / "a.las"}, folder / "a.stipple");
    fs::copy(folder / "a.stipple", folder / "cloud");
    CHECK(prepare(folder / "a.stipple") == folder / "a.stipple");
    CHECK(prepare(folder / "cloud") == folder / "cloud");
    CHECK(prepare(folder / ".") == folder / ".");
    auto absent = server::prepareInput(folder / "none.las", never);
    REQUIRE_FALSE(absent.ok());
    CHECK(absent.error().code == ErrorCode::notFound);
}
