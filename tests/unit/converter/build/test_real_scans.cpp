#include "converter/build/verify.hpp"
#include "converter/export/export_file.hpp"
#include "tests/support/data.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <algorithm>

using namespace stipple;
using namespace stipple::test;

namespace {
// Converts, verifies against the input, exports, and verifies against what was exported.
void roundTrip(const std::string& scan) {
    INFO(scan);
    TemporaryFolder folder;
    convertOrFail({scan}, folder / "c.stipple");
    auto report = verifyFile(folder / "c.stipple", {scan}, 2, nullptr, noProgress);
    REQUIRE(report.ok());
    INFO((report->faults.empty() ? "" : report->faults[0]));
    CHECK(report->passed());
    auto exported = exportFile(folder / "c.stipple", folder / "out.las", {}, noProgress);
    if (!exported)
        FAIL(exported.error().sentence());
    auto again = verifyFile(folder / "c.stipple", {folder / "out.las"}, 2, nullptr, noProgress);
    REQUIRE(again.ok());
    INFO((again->faults.empty() ? "" : again->faults[0]));
    CHECK(again->passed());
}
} // namespace

TEST_CASE("real scans of every point format lose nothing", "[real]") {
    STIPPLE_NEEDS_DATA();
    std::vector<std::string> scans;
    for (const auto& entry : std::filesystem::directory_iterator(dataPath("las-pairs")))
        if (entry.path().extension() == ".las")
            scans.push_back(entry.path().string());
    std::sort(scans.begin(), scans.end());
    REQUIRE(scans.size() > 15);
    for (const std::string& scan : scans)
        roundTrip(scan);
}

TEST_CASE("real scans with odd headers are converted or refused in words", "[real]") {
    STIPPLE_NEEDS_DATA();
    for (const auto& entry : std::filesystem::directory_iterator(dataPath("las-odd"))) {
        TemporaryFolder folder;
        std::string scan = entry.path().string();
        auto result = convertFiles({scan}, folder / "c.stipple", {}, noProgress);
        INFO(scan << (result.ok() ? "" : ": " + result.error().sentence()));
        if (!result) {
            CHECK(result.error().sentence().find(entry.path().filename().string()) != std::string::npos);
            CHECK(folder.files() == 0);
        } else {
            roundTrip(scan);
        }
    }
}
