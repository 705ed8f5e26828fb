#include "converter/build/verify.hpp"
#include "converter/export/export_file.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {
// The conversion fails with `code`, names `place`, and leaves nothing new in the folder.
void checkRefused(TemporaryFolder& folder, const std::vector<std::string>& inputs, const std::string& output,
                  ErrorCode code, const std::string& place, const std::string& text) {
    std::size_t before = folder.files();
    auto result = convertFiles(inputs, output, {}, noProgress);
    REQUIRE_FALSE(result.ok());
    INFO(result.error().sentence());
    CHECK(std::string(errorCodeName(result.error().code)) == errorCodeName(code));
    CHECK(result.error().sentence().find(place) != std::string::npos);
    CHECK(result.error().sentence().find(text) != std::string::npos);
    CHECK(folder.files() == before);
}

void writeText(const std::string& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}
} // namespace

TEST_CASE("inputs that can't be read are refused by name, and nothing is left behind", "[convert]") {
    TemporaryFolder folder;
    std::string output = folder / "out.stipple";
    checkRefused(folder, {folder / "none.las"}, output, ErrorCode::notFound, "none.las", "");
    std::filesystem::create_directory(folder / "folder");
    checkRefused(folder, {folder / "folder"}, output, ErrorCode::unsupported, "folder", "is a folder");
    writeText(folder / "text.las", "a poem\nof two lines\n");
    checkRefused(folder, {folder / "text.las"}, output, ErrorCode::unsupported, "text.las",
                 "of no kind that is read");
    writeText(folder / "mesh.las", "ply\nformat ascii 1.0\n");
    checkRefused(folder, {folder / "mesh.las"}, output, ErrorCode::truncated, "mesh.las", "end_header");
    writeText(folder / "photo.las", "\xFF\xD8\xFF\xE0");
    checkRefused(folder, {folder / "photo.las"}, output, ErrorCode::unsupported, "photo.las", "JPEG");
    writeText(folder / "empty.las", "");
    checkRefused(folder, {folder / "empty.las"}, output, ErrorCode::truncated, "empty.las",
                 "the file is empty");
    checkRefused(folder, {}, output, ErrorCode::invalidArgument, "", "no input");
}

TEST_CASE("a LAS file cut inside its header is refused, one cut inside its points gives those that are there",
          "[convert]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(0, 1000, 1);
    writeScan(scan, folder / "whole.las");
    Bytes bytes = fileBytes(folder / "whole.las");
    std::string text(bytes.begin(), bytes.end());
    writeText(folder / "head.las", text.substr(0, 150));
    checkRefused(folder, {folder / "head.las"}, folder / "out.stipple", ErrorCode::truncated, "head.las", "");
    writeText(folder / "points.las", text.substr(0, text.size() - 1010)); // 50.5 records of 20 bytes
    ConvertResult result = convertOrFail({folder / "points.las"}, folder / "out.stipple");
    CHECK(result.metadata.pointCount == 949);
    CHECK_FALSE(result.warnings.empty());
}

TEST_CASE("points that claim to be compressed, without the record that says how, are refused", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 10, 1), folder / "in.las");
    Bytes bytes = fileBytes(folder / "in.las");
    bytes[104] |= 0x80;
    writeText(folder / "in.laz", std::string(bytes.begin(), bytes.end()));
    checkRefused(folder, {folder / "in.laz"}, folder / "out.stipple", ErrorCode::corrupt, "in.laz",
                 "laszip encoded");
}

TEST_CASE("an output of value is never replaced", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "in.las");
    checkRefused(folder, {folder / "in.las"}, folder / "in.las", ErrorCode::invalidArgument, "in.las",
                 "one of the inputs");
    checkRefused(folder, {folder / "in.las", folder / "in.las"}, folder / "out.stipple",
                 ErrorCode::invalidArgument, "in.las", "given twice");
    writeText(folder / "notes.txt", "years of work");
    checkRefused(folder, {folder / "in.las"}, folder / "notes.txt", ErrorCode::writeFailed, "notes.txt",
                 "exists");
    checkRefused(folder, {folder / "in.las"}, folder / "none/out.stipple", ErrorCode::writeFailed,
                 "none/out.stipple", "folder");
    std::filesystem::create_directory(folder / "folder");
    checkRefused(folder, {folder / "in.las"}, folder / "folder", ErrorCode::writeFailed, "folder",
                 "is a folder");
    CHECK(fileBytes(folder / "notes.txt").size() == 13);

    convertOrFail({folder / "in.las"}, folder / "notes.txt", {.force = true});
    convertOrFail({folder / "in.las"}, folder / "notes.txt"); // a cloud by now
}

TEST_CASE("inputs in two coordinate systems are refused with both names", "[convert]") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(6, 100, 1);
    auto write = [&](const std::string& name, const std::string& wkt) {
        las::WriterOptions options;
        options.grid = scan.grid;
        options.schema = scan.schema;
        options.pointFormat = 6;
        options.wkt = wkt;
        auto writer = las::Writer::create(folder / name, options);
        REQUIRE(writer.ok());
        REQUIRE((*writer)->write(scan.points).ok());
        REQUIRE((*writer)->finish().ok());
    };
    auto utm = [](int zone) {
        return "PROJCS[\"WGS 84 / UTM zone " + std::to_string(zone) +
               "N\",GEOGCS[\"WGS 84\",DATUM[\"WGS_1984\",SPHEROID[\"WGS "
               "84\",6378137,298.257223563]],PRIMEM[\"Greenwich\",0],UNIT[\"degree\",0.0174532925199433]],"
               "PROJECTION["
               "\"Transverse_Mercator\"],PARAMETER[\"latitude_of_origin\",0],PARAMETER[\"central_"
               "meridian\"," +
               std::to_string(6 * zone - 183) +
               "],PARAMETER[\"scale_factor\",0.9996],PARAMETER[\"false_easting\",500000],PARAMETER[\"false_"
               "northing\",0],UNIT[\"metre\",1],AUTHORITY[\"EPSG\",\"" +
               std::to_string(32600 + zone) + "\"]]";
    };
    write("a.las", utm(10));
    write("b.las", utm(11));
    checkRefused(folder, {folder / "a.las", folder / "b.las"}, folder / "out.stipple",
                 ErrorCode::invalidArgument, "b.las", "UTM zone 11N");
    ConvertResult result = convertOrFail({folder / "a.las"}, folder / "out.stipple");
    CHECK(result.metadata.crs.epsg == 32610);
}

TEST_CASE("a CRS can be set where none is stated", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "in.las");
    ConvertOptions options;
    options.crs = "EPSG:26910";
    ConvertResult result = convertOrFail({folder / "in.las"}, folder / "out.stipple", options);
    CHECK(result.metadata.crs.epsg == 26910);
    options.crs = "no such system at all";
    auto refused = convertFiles({folder / "in.las"}, folder / "out2.stipple", options, noProgress);
    REQUIRE_FALSE(refused.ok());
    CHECK(refused.error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a stopped conversion is cancelled and leaves nothing", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 1000, 1), folder / "in.las");
    std::atomic<bool> stop{true};
    ConvertOptions options;
    options.stop = &stop;
    auto result = convertFiles({folder / "in.las"}, folder / "out.stipple", options, noProgress);
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::cancelled);
    CHECK(folder.files() == 1);
}

TEST_CASE("verify and export refuse what is no cloud", "[convert]") {
    TemporaryFolder folder;
    writeScan(surfaceScan(0, 100, 1), folder / "in.las");
    auto verified = verifyFile(folder / "in.las", {}, {.threads = 1}, noProgress);
    REQUIRE_FALSE(verified.ok());
    CHECK(verified.error().sentence().find("in.las") != std::string::npos);
    auto exported = exportFile(folder / "in.las", folder / "out.las", {}, noProgress);
    REQUIRE_FALSE(exported.ok());
    CHECK(folder.files() == 1);
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    auto same = exportFile(folder / "c.stipple", folder / "c.stipple",
                           ExportOptions{.format = ExportFormat::las, .force = true}, noProgress);
    REQUIRE_FALSE(same.ok());
    CHECK(same.error().code == ErrorCode::invalidArgument);
}
