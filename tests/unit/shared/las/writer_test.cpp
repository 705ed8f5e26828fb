// Which format and version the writer chooses, what it refuses, and what it leaves behind.
#include "tests/unit/shared/las/las_bytes.hpp"

#include <limits>

#ifndef __EMSCRIPTEN__
#include <csignal>
#include <sys/resource.h>
#endif

using namespace stipple;
using namespace stipple::test;

namespace {

Attribute attributeOf(std::string_view name) {
    for (int format : {5, 10}) {
        Schema schema = las::schemaOf(format);
        if (int a = schema.find(name); a >= 0)
            return schema.attributes[static_cast<std::size_t>(a)];
    }
    FAIL("no LAS attribute is named " << name);
    return {};
}

las::WriterOptions optionsWith(std::initializer_list<std::string_view> names) {
    las::WriterOptions options;
    for (std::string_view name : names)
        options.schema.attributes.push_back(attributeOf(name));
    return options;
}

PointBatch zeroPoints(const las::WriterOptions& options, std::size_t count) {
    PointBatch points;
    points.resize(options.schema, count);
    return points;
}

LasContents requireWritten(const las::WriterOptions& options, const PointBatch& points) {
    auto bytes = writeLas(options, points);
    if (!bytes.ok())
        FAIL(bytes.error().sentence());
    return requireLas(*bytes);
}

Error requireRefused(const las::WriterOptions& options) {
    TemporaryFolder folder;
    auto writer = las::Writer::create(folder.file("out.las"), options);
    REQUIRE(!writer.ok());
    CHECK(writer.error().where.find("out.las") != std::string::npos);
    CHECK(folder.fileCount() == 0);
    return writer.error();
}

} // namespace

TEST_CASE("the smallest format that holds the attributes is chosen, and the lowest version for it") {
    struct {
        std::initializer_list<std::string_view> names;
        int format, minor;
    } cases[] = {
        {{}, 0, 2},
        {{"Intensity", "Withheld", "Scan Angle Rank"}, 0, 2},
        {{"GPS Time"}, 1, 2},
        {{"Red", "Green", "Blue"}, 2, 2},
        {{"Red", "GPS Time"}, 3, 2},
        {{"Parametric dx"}, 4, 3},
        {{"Parametric dx", "Red"}, 5, 3},
        {{"Overlap"}, 6, 4},
        {{"Scan Angle", "Red"}, 7, 4},
        {{"NIR"}, 8, 4},
        {{"Scanner Channel", "Parametric dx"}, 9, 4},
        {{"NIR", "Parametric dx"}, 10, 4},
    };
    for (const auto& c : cases) {
        CAPTURE(c.format);
        las::WriterOptions options = optionsWith(c.names);
        LasContents las = requireWritten(options, zeroPoints(options, 3));
        CHECK(las.header.pointFormat == c.format);
        CHECK(las.header.versionMinor == c.minor);
        CHECK(las.header.recordLength == las::pointRecordSize(c.format));
        CHECK(las.warnings.empty());
    }
}

TEST_CASE("a LAS attribute that the format has no field for is kept in extra bytes") {
    las::WriterOptions options = optionsWith({"Scan Angle Rank", "Scan Angle", "NIR", "GPS Time"});
    PointBatch points = zeroPoints(options, 2);
    points.setValue<std::int8_t>(0, 1, -90);
    points.setValue<std::int16_t>(1, 1, -30000);
    LasContents las = requireWritten(options, points);
    CHECK(las.header.pointFormat == 8);
    CHECK(las.points.value<std::int8_t>(las.schema.find("Scan Angle Rank"), 1) == -90);
    CHECK(las.points.value<std::int16_t>(las.schema.find("Scan Angle"), 1) == -30000);

    options = optionsWith({"GPS Time"});
    options.pointFormat = 0;
    points = zeroPoints(options, 1);
    points.setValue<double>(0, 0, 12.5);
    las = requireWritten(options, points);
    CHECK(las.header.pointFormat == 0);
    CHECK(las.points.value<double>(las.schema.find("GPS Time"), 0) == 12.5);
}

TEST_CASE("counts, returns and bounds are those of the points") {
    las::WriterOptions options = optionsWith({"Return Number", "GPS Time"});
    options.grid = {{0.5, 0.25, 2}, {10, 20, -30}};
    PointBatch points = zeroPoints(options, 4);
    points.positions = {{-4, 8, 1}, {2, -8, 3}, {0, 0, -5}, {1, 1, 1}};
    std::uint8_t returns[] = {1, 2, 2, 7};
    std::memcpy(points.columns[0].data(), returns, 4);
    for (int minor : {2, 4}) {
        options.versionMinor = minor;
        LasContents las = requireWritten(options, points);
        CHECK(las.header.pointCount == 4);
        CHECK(las.header.pointsByReturn[0] == 1);
        CHECK(las.header.pointsByReturn[1] == 2);
        CHECK(las.header.bounds.min == Vec3d{8, 18, -40});
        CHECK(las.header.bounds.max == Vec3d{11, 22, -24});
        BoxI box;
        for (Vec3i p : points.positions)
            box.extend(p);
        CHECK(!las::boundsContradiction(las.header, box));
    }
}

TEST_CASE("legacy counts are written where older readers can use them, and only there") {
    auto legacyCount = [](int minor, int format) {
        las::WriterOptions options;
        options.versionMinor = minor;
        options.pointFormat = format;
        auto bytes = writeLas(options, zeroPoints(options, 3));
        REQUIRE(bytes.ok());
        return loadLe<std::uint32_t>(bytes->data() + atLegacyCount);
    };
    CHECK(legacyCount(2, 1) == 3);
    CHECK(legacyCount(4, 1) == 3);
    CHECK(legacyCount(4, 6) == 0);
}

TEST_CASE("WKT and further records are written, large ones after the points") {
    las::WriterOptions options = optionsWith({"Intensity"});
    options.wkt = "PROJCS[\"somewhere\"]";
    options.vlrs = {{"someone", 1, "small", Bytes(10, 1)},
                    {"someone", 2, "large", Bytes(70000, 2)},
                    {"someone", 3, "asked for", Bytes(5, 3), true}};
    LasContents las = requireWritten(options, zeroPoints(options, 3));
    CHECK(las.warnings.empty());
    CHECK(las.header.versionMinor == 4);
    CHECK((las.header.globalEncoding & 16) != 0);
    CHECK(las::wktRecord(las.header) == options.wkt);
    REQUIRE(las.header.vlrs.size() == 4);
    CHECK(las.header.vlrs[1].data == options.vlrs[0].data);
    CHECK(las.header.vlrs[2].data == options.vlrs[1].data);
    CHECK(las.header.vlrs[2].extended);
    CHECK(las.header.vlrs[3].data == options.vlrs[2].data);

    options.versionMinor = 2;
    options.vlrs.resize(1);
    las = requireWritten(options, zeroPoints(options, 3));
    CHECK(las::wktRecord(las.header) == options.wkt);
    CHECK((las.header.globalEncoding & 16) == 0); // that bit is LAS 1.4's
}

TEST_CASE("points beyond 2^32 - 1 are announced, and get LAS 1.4") {
    las::WriterOptions options = optionsWith({"Intensity"});
    options.expectedPoints = 1ull << 32;
    CHECK(requireWritten(options, zeroPoints(options, 1)).header.versionMinor == 4);
}

TEST_CASE("values too large for their fields are refused with their point") {
    auto refused = [](const las::WriterOptions& options, const PointBatch& points) {
        TemporaryFolder folder;
        {
            auto writer = las::Writer::create(folder.file("out.las"), options);
            REQUIRE(writer.ok());
            Status written = (*writer)->write(points);
            REQUIRE(!written.ok());
            CHECK(written.error().code == ErrorCode::outOfRange);
            CHECK(!(*writer)->finish().ok());
            CHECK(written.error().where.find("point 700 of the batch") != std::string::npos);
        }
        CHECK(folder.fileCount() == 0);
    };
    las::WriterOptions options = optionsWith({"Return Number"});
    PointBatch points = zeroPoints(options, 1000);
    points.setValue<std::uint8_t>(0, 700, 9);
    refused(options, points);
    options.pointFormat = 6;
    CHECK(requireWritten(options, points).points.columns[1][700] == 9);

    options = optionsWith({});
    points = zeroPoints(options, 1000);
    for (std::int64_t value :
         {std::int64_t{1} << 31, -(std::int64_t{1} << 31) - 1, std::numeric_limits<std::int64_t>::min()}) {
        points.positions[700].y = value;
        refused(options, points);
    }
    points.positions[700] = {2147483647, -2147483648ll, 0};
    CHECK(requireWritten(options, points).points.positions == points.positions);
}

TEST_CASE("schemas and options that LAS can't hold are refused") {
    las::WriterOptions options;
    options.schema.attributes = {{"Intensity", AttributeType::f32}};
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.schema.attributes = {{"matrix", AttributeType::f32, 9}};
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.schema.attributes = {{"a", AttributeType::f32}, {"a", AttributeType::u8}};
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.schema.attributes.assign(400, {});
    for (std::size_t i = 0; i < 400; ++i)
        options.schema.attributes[i].name = "n" + std::to_string(i);
    CHECK(requireRefused(options).what.find("more than the 341") != std::string::npos);
    options.schema.attributes.clear();
    options.grid.scale.y = 0;
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.grid.scale.y = 1;
    options.pointFormat = 11;
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.pointFormat = 6;
    options.versionMinor = 3;
    CHECK(requireRefused(options).what == "LAS 1.3 has no point format 6");
    options.versionMinor = 4;
    options.vlrs = {{"LASF_Spec", 4, "", Bytes(192)}};
    CHECK(requireRefused(options).code == ErrorCode::invalidArgument);
    options.pointFormat = 0;
    options.versionMinor = 2;
    options.vlrs = {{"someone", 4, "", Bytes(70000)}};
    CHECK(requireRefused(options).what.find("needs LAS 1.4") != std::string::npos);
}

TEST_CASE("names that are too long are cut between characters, with a warning") {
    las::WriterOptions options;
    std::string name(31, 'a');
    name += "\xC3\xA4z"; // an umlaut across the 32nd byte
    options.schema.attributes = {{name, AttributeType::u8}};
    TemporaryFolder folder;
    auto writer = las::Writer::create(folder.file("out.las"), options);
    REQUIRE(writer.ok());
    CHECK((*writer)->warnings().size() == 1);
    REQUIRE((*writer)->finish().ok());
    LasContents las = requireLas(fileBytes(folder.file("out.las")));
    CHECK(las.schema.attributes.back().name == std::string(31, 'a'));
}

TEST_CASE("a file has its name only when it is finished") {
    TemporaryFolder folder;
    las::WriterOptions options = optionsWith({"Intensity"});
    {
        auto writer = las::Writer::create(folder.file("out.las"), options);
        REQUIRE(writer.ok());
        REQUIRE((*writer)->write(zeroPoints(options, 10)).ok());
        CHECK(!std::filesystem::exists(folder.file("out.las")));
        CHECK(folder.fileCount() == 1);
    }
    CHECK(folder.fileCount() == 0);
    {
        auto writer = las::Writer::create(folder.file("out.las"), options);
        REQUIRE((*writer)->finish().ok());
        CHECK(!(*writer)->finish().ok());
        CHECK(!(*writer)->write(zeroPoints(options, 1)).ok());
    }
    CHECK(folder.fileCount() == 1);
    CHECK(requireLas(fileBytes(folder.file("out.las"))).points.size() == 0);
}

TEST_CASE("a batch that does not fit the schema is refused") {
    TemporaryFolder folder;
    las::WriterOptions options = optionsWith({"Intensity"});
    auto writer = las::Writer::create(folder.file("out.las"), options);
    REQUIRE(writer.ok());
    PointBatch points = zeroPoints(options, 2);
    points.columns[0].pop_back();
    CHECK((*writer)->write(points).error().code == ErrorCode::invalidArgument);
    points.columns.clear();
    CHECK((*writer)->write(points).error().code == ErrorCode::invalidArgument);
    REQUIRE((*writer)->write(zeroPoints(options, 2)).ok());
    CHECK((*writer)->finish().ok());
}

TEST_CASE("the same points in other batches give the same bytes") {
    LasRecipe recipe{4, 7, 1000};
    recipe.extraBytes = 3;
    MemorySource source(lasBytes(recipe));
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    auto written = [&](std::uint64_t batchPoints) {
        TemporaryFolder folder;
        auto writer = las::Writer::create(folder.file("out.las"), las::optionsLike(**reader));
        REQUIRE(writer.ok());
        PointBatch batch;
        for (std::uint64_t first = 0; first < 1000; first += batchPoints) {
            REQUIRE((*reader)->read(first, batchPoints, batch).ok());
            REQUIRE((*writer)->write(batch).ok());
        }
        REQUIRE((*writer)->finish().ok());
        return fileBytes(folder.file("out.las"));
    };
    Bytes whole = written(1000);
    CHECK(written(1) == whole);
    CHECK(written(333) == whole);
}

#ifndef __EMSCRIPTEN__
TEST_CASE("a disk that takes no more leaves an error and no file") {
    // A limit on file sizes stands in for a full disk: write fails in the middle.
    TemporaryFolder folder;
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit small = before;
    small.rlim_cur = 100'000;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &small) == 0);
    Status written;
    {
        las::WriterOptions options = optionsWith({"Intensity"});
        auto writer = las::Writer::create(folder.file("out.las"), options);
        if (writer.ok())
            written = (*writer)->write(zeroPoints(options, 100'000));
    }
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    REQUIRE(!written.ok());
    CHECK(written.error().code == ErrorCode::writeFailed);
    CHECK(folder.fileCount() == 0);
}
#endif
