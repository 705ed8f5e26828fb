#include "tests/unit/converter/input/e57/read_all.hpp"

#include "shared/base/text.hpp"

#include <cmath>
#include <random>

using namespace stipple;
using namespace stipple::test;
using Catch::Matchers::Contains;

namespace {
std::vector<std::int64_t> randomIntegers(std::size_t count, std::int64_t low, std::int64_t high,
                                         unsigned seed) {
    std::mt19937_64 random(seed);
    std::vector<std::int64_t> values(count);
    std::uint64_t range = static_cast<std::uint64_t>(high) - static_cast<std::uint64_t>(low);
    for (std::int64_t& value : values)
        value = static_cast<std::int64_t>(static_cast<std::uint64_t>(low) +
                                          (range == ~0ull ? random() : random() % (range + 1)));
    return values;
}

// Millimetres, on a grid.
E57Scan gridScan(std::size_t count, unsigned seed = 1) {
    E57Scan scan;
    for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
        scan.fields.push_back(
            scaledField(name, -500000, 500000, "0.001", "0", randomIntegers(count, -500000, 500000, seed++)));
    return scan;
}
E57Scan floatScan(const std::vector<Vec3d>& points) {
    E57Scan scan;
    std::vector<float> axes[3];
    for (Vec3d p : points)
        for (int axis = 0; axis < 3; ++axis)
            axes[axis].push_back(static_cast<float>(p[axis]));
    scan.fields = {floatField("cartesianX", axes[0]), floatField("cartesianY", axes[1]),
                   floatField("cartesianZ", axes[2])};
    return scan;
}
std::vector<std::int64_t> stored(const E57Points& points, int axis) {
    std::vector<std::int64_t> result;
    for (Vec3i p : points.points.positions)
        result.push_back(p[axis]);
    return result;
}
std::vector<std::int64_t> decoded(const E57Field& field, std::int64_t minimum) {
    std::vector<std::int64_t> result;
    for (std::uint64_t code : field.codes)
        result.push_back(static_cast<std::int64_t>(code + static_cast<std::uint64_t>(minimum)));
    return result;
}
std::string rotationXml(double w, double x, double y, double z) {
    return cat("<rotation><w type=\"Float\">", w, "</w><x type=\"Float\">", x, "</x><y type=\"Float\">", y,
               "</y><z type=\"Float\">", z, "</z></rotation>");
}
std::string translationXml(const char* x, const char* y, const char* z) {
    return cat("<translation><x type=\"Float\">", x, "</x><y type=\"Float\">", y, "</y><z type=\"Float\">", z,
               "</z></translation>");
}
} // namespace

TEST_CASE("scaled integers keep their integers, their grid and their order") {
    E57Scan scan = gridScan(5000);
    E57Points read = readE57({{scan}, ""});
    REQUIRE(read.points.size() == 5000);
    CHECK(read.description.grid.scale == Vec3d{0.001, 0.001, 0.001});
    CHECK(read.description.grid.offset == Vec3d{0, 0, 0});
    for (int axis = 0; axis < 3; ++axis)
        CHECK(stored(read, axis) == decoded(scan.fields[static_cast<std::size_t>(axis)], -500000));
    CHECK(read.report.maxRounding == 0);
    CHECK(read.description.source.format == "E57 1.0, 1 scan");
}

TEST_CASE("fields of every width are unpacked, wherever packets cut their streams") {
    for (std::size_t bytesPerPacket : {1, 3, 7, 64, 997, 6000}) {
        E57Scan scan = gridScan(bytesPerPacket == 1 ? 40 : 700);
        std::size_t count = scan.records();
        scan.bytesPerPacket = bytesPerPacket;
        scan.emptyPackets = bytesPerPacket != 64;
        std::vector<std::vector<std::int64_t>> expected;
        for (int bits = 1; bits <= 64; bits += bytesPerPacket > 900 ? 1 : 9) {
            std::int64_t low =
                bits == 64 ? std::numeric_limits<std::int64_t>::min() : -(std::int64_t{1} << (bits - 1));
            std::int64_t high = bits == 64 ? std::numeric_limits<std::int64_t>::max()
                                           : low + static_cast<std::int64_t>((std::uint64_t{1} << bits) - 1);
            expected.push_back(randomIntegers(count, low, high, 100u + static_cast<unsigned>(bits)));
            scan.fields.push_back(integerField(cat("ext:bits", bits), low, high, expected.back()));
        }
        if (scan.fields.size() * bytesPerPacket > 65000)
            scan.bytesPerPacket = 900;
        E57Points read = readE57({{scan}, ""});
        REQUIRE(read.points.size() == count);
        CHECK(stored(read, 2) == decoded(scan.fields[2], -500000));
        std::size_t f = 0;
        for (int bits = 1; bits <= 64; bits += bytesPerPacket > 900 ? 1 : 9, ++f) {
            std::string name = cat("ext:bits", bits);
            INFO(name);
            std::vector<std::int64_t> found;
            switch (read.attribute(name).type) {
            case AttributeType::i8:
                for (auto v : read.values<std::int8_t>(name))
                    found.push_back(v);
                break;
            case AttributeType::i16:
                for (auto v : read.values<std::int16_t>(name))
                    found.push_back(v);
                break;
            case AttributeType::i32:
                for (auto v : read.values<std::int32_t>(name))
                    found.push_back(v);
                break;
            default:
                found = read.values<std::int64_t>(name);
            }
            CHECK(found == expected[f]);
        }
    }
}

TEST_CASE("a field of one possible value takes no bytes") {
    E57Scan scan = gridScan(100);
    scan.fields[2] = scaledField("cartesianZ", 77, 77, "0.001", "0", std::vector<std::int64_t>(100, 77));
    CHECK(stored(readE57({{scan}, ""}), 2) == std::vector<std::int64_t>(100, 77));
}

TEST_CASE("streams that begin anew at a flagged packet are read on") {
    for (std::size_t restart : {1, 7, 100}) {
        E57Scan scan = gridScan(333);
        scan.recordsPerRestart = restart;
        scan.bytesPerPacket = 50;
        E57Points read = readE57({{scan}, ""});
        CHECK(stored(read, 0) == decoded(scan.fields[0], -500000));
    }
    E57Scan scan = gridScan(20);
    scan.flagFirst = true;
    CHECK(readE57({{scan}, ""}).points.size() == 20);
}

TEST_CASE("a large scan is divided into parts that are read on their own") {
    E57Scan scan = gridScan(700000);
    scan.fields.push_back(integerField("cartesianInvalidState", 0, 2, randomIntegers(700000, 0, 2, 9)));
    scan.fields.push_back(integerField("rowIndex", 0, 1, randomIntegers(700000, 0, 1, 10)));
    scan.bytesPerPacket = 10000;
    E57Points read = readE57({{scan}, ""});
    CHECK(read.parts.size() == 3);
    std::vector<std::int64_t> x = decoded(scan.fields[0], -500000), kept;
    std::vector<std::uint8_t> rows;
    for (std::size_t i = 0; i < x.size(); ++i)
        if (scan.fields[3].codes[i] == 0) {
            kept.push_back(x[i]);
            rows.push_back(static_cast<std::uint8_t>(scan.fields[4].codes[i]));
        }
    CHECK((stored(read, 0) == kept));
    CHECK((read.values<std::uint8_t>("rowIndex") == rows));
    CHECK(read.report.invalid == 700000 - kept.size());
}

TEST_CASE("floats lie on a grid that tells them apart, and the rounding is stated") {
    std::vector<Vec3d> points{{0.1f, -12.345678f, 3.0f}, {0.10000001f, 99.999992f, -0.5f}};
    E57Points read = readE57({{floatScan(points)}, ""});
    REQUIRE(read.points.size() == 2);
    CHECK(read.description.boundsAreMeasured);
    for (std::size_t i = 0; i < 2; ++i)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(std::abs(read.world()[i][axis] - points[i][axis]) <= read.report.maxRounding);
    CHECK(read.report.maxRounding > 0);
    CHECK(read.report.maxRounding <= read.description.grid.scale.x / 2 * 1.0001);
    CHECK(read.description.grid.scale.x <= 7.7e-6 / 2); // half the spacing of floats near 100
    CHECK(readE57({{floatScan(points)}, ""}, 0.001).description.grid.scale.x == 0.001);
}

TEST_CASE("doubles are read, and coordinates that are no numbers are dropped") {
    E57Scan scan;
    double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    scan.fields = {doubleField("cartesianX", {500000.125, nan, 1, 1e300}),
                   doubleField("cartesianY", {1, 2, -infinite, 3}), doubleField("cartesianZ", {0, 0, 0, 0}),
                   integerField("rowIndex", 0, 9, {1, 2, 3, 4})};
    E57Points read = readE57({{scan}, ""});
    REQUIRE(read.points.size() == 1);
    CHECK(std::abs(read.world()[0].x - 500000.125) <= 1e-9);
    CHECK(read.report.notFinite == 2);
    CHECK(read.report.outOfRange == 1);
    CHECK(read.values<std::uint8_t>("rowIndex") == std::vector<std::uint8_t>{1});
}

TEST_CASE("a translated scan of scaled integers stays exact") {
    E57Scan scan = gridScan(50);
    scan.xml = cat("<pose type=\"Structure\">", rotationXml(1, 0, 0, 0),
                   translationXml("500000.5", "-20.25", "0"), "</pose>");
    E57Points read = readE57({{scan}, ""});
    CHECK(read.description.grid.offset == Vec3d{500000.5, -20.25, 0});
    CHECK(stored(read, 1) == decoded(scan.fields[1], -500000));
    CHECK(read.report.maxRounding == 0);
}

TEST_CASE("scans with steps of their own share the coarsest grid that holds all exactly") {
    E57Scan a = gridScan(50), b = gridScan(50, 5);
    b.xml = cat("<pose type=\"Structure\">", translationXml("0.0005", "10", "-1"), "</pose>");
    E57Points read = readE57({{a, b}, ""});
    REQUIRE(read.points.size() == 100);
    CHECK(read.description.grid.scale == Vec3d{0.0005, 0.001, 0.001});
    for (std::size_t i = 0; i < 50; ++i) {
        CHECK(std::abs(read.world()[i].x - 0.001 * static_cast<double>(decoded(a.fields[0], -500000)[i])) <
              1e-9);
        CHECK(std::abs(read.world()[50 + i].x - 0.0005 -
                       0.001 * static_cast<double>(decoded(b.fields[0], -500000)[i])) < 1e-9);
    }
    CHECK(read.report.maxRounding == 0);
    auto ids = read.values<std::uint16_t>("Point Source ID");
    CHECK(std::count(ids.begin(), ids.end(), 1) == 50);
    CHECK(std::count(ids.begin(), ids.end(), 2) == 50);
}

TEST_CASE("a rotated scan is turned, then moved, and lands within a quarter of its step") {
    E57Scan scan;
    scan.fields = {scaledField("cartesianX", 0, 100000, "0.001", "0", {1000, 0, 2000}),
                   scaledField("cartesianY", 0, 100000, "0.001", "0", {0, 3000, 2000}),
                   scaledField("cartesianZ", 0, 100000, "0.001", "5", {0, 0, 1})};
    double half = std::sqrt(0.5); // a quarter turn about z: x to y, y to -x
    scan.xml = cat("<pose type=\"Structure\">", rotationXml(half, 0, 0, half),
                   translationXml("10", "20", "30"), "</pose>");
    E57Points read = readE57({{scan}, ""});
    REQUIRE(read.points.size() == 3);
    std::vector<Vec3d> expected{{10, 21, 35}, {7, 20, 35}, {8, 22, 35.001}};
    for (std::size_t i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(std::abs(read.world()[i][axis] - expected[i][axis]) < 1e-9);
    CHECK(read.description.grid.scale.x == 0.0001);
    CHECK(read.report.maxRounding <= 0.00025);
}

TEST_CASE("rotated scans that several threads measure are what one finds, and the first error is told") {
    TemporaryFolder folder;
    E57File file;
    for (int s = 0; s < 7; ++s) {
        std::vector<std::int64_t> x, y, z;
        for (int i = 0; i < 2000 + 100 * s; ++i) {
            x.push_back(i * 37 % 5000);
            y.push_back(i * 91 % 3000 + s);
            z.push_back(i % 100 * s);
        }
        E57Scan& scan = file.scans.emplace_back();
        scan.fields = {scaledField("cartesianX", 0, 100000, "0.001", "0", x),
                       scaledField("cartesianY", 0, 100000, "0.001", "0", y),
                       scaledField("cartesianZ", 0, 100000, "0.001", "5", z)};
        scan.xml = cat("<pose type=\"Structure\">", rotationXml(0.8, 0, 0, 0.6),
                       translationXml("10", "20", "30"), "</pose>");
    }
    const Bytes bytes = file.bytes();
    std::string path = writeBytes(folder.file("scan.e57"), bytes);
    auto one = readE57(path);
    REQUIRE(one.ok());
    REQUIRE(one->points.size() == 7 * 2000 + 2100);
    for (int threads : {2, 5}) {
        auto several = readE57(path, 0, threads);
        REQUIRE(several.ok());
        CHECK(several->description.bounds == one->description.bounds);
        CHECK(several->description.grid.scale == one->description.grid.scale);
        CHECK(several->description.grid.offset == one->description.grid.offset);
        CHECK((several->points.positions == one->points.positions));
    }
    // Pages of two scans are damaged: of the first one it is told, whoever meets which.
    Bytes damaged = bytes;
    damaged[bytes.size() / 3] ^= 1;
    damaged[bytes.size() / 2] ^= 1;
    writeBytes(path, damaged);
    auto refused = readE57(path);
    REQUIRE_FALSE(refused.ok());
    for (int threads : {2, 5}) {
        auto also = readE57(path, 0, threads);
        REQUIRE_FALSE(also.ok());
        CHECK(also.error().sentence() == refused.error().sentence());
    }
}

TEST_CASE("a rotated scan with an absurdly fine step is placed as finely as doubles tell") {
    E57Scan scan;
    for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"})
        scan.fields.push_back(scaledField(name, 0, 100, "1e-300", "7", {5, 6}));
    scan.xml = cat("<pose>", rotationXml(std::sqrt(0.5), 0, 0, std::sqrt(0.5)), "</pose>");
    E57Points read = readE57({{scan}, ""});
    CHECK(std::abs(read.world()[0].x + 7) < 1e-12);
    CHECK(std::abs(read.world()[1].y - 7) < 1e-12);
    CHECK(read.report.maxRounding < 1e-12);
}

TEST_CASE("small floats far from the origin keep their digits") {
    E57Scan scan = floatScan({{1.0000001f, 2, 3}, {1.0000002f, 2, 3}});
    scan.xml = cat("<pose type=\"Structure\">", translationXml("500000", "4000000", "0"), "</pose>");
    E57Points read = readE57({{scan}, ""});
    CHECK(read.points.positions[0].x != read.points.positions[1].x);
    CHECK(std::abs(read.world()[0].x - 500001) < 1e-6);
    CHECK(std::abs(read.world()[0].y - 4000002) < 1e-6);
}

TEST_CASE("a rotation of another length than 1 is scaled, one of length 0 is none; both are said") {
    E57Scan scan = floatScan({{1, 0, 0}});
    scan.xml = cat("<pose>", rotationXml(2, 0, 0, 2), "</pose>");
    E57Points read = readE57({{scan}, ""});
    CHECK(std::abs(read.world()[0].y - 1) < 1e-6);
    REQUIRE(read.description.warnings.size() == 1);
    CHECK_THAT(read.description.warnings[0], Contains("not 1"));
    scan.xml = cat("<pose>", rotationXml(0, 0, 0, 0), "</pose>");
    read = readE57({{scan}, ""});
    CHECK(std::abs(read.world()[0].x - 1) < 1e-6);
    CHECK_THAT(read.description.warnings[0], Contains("not rotated"));
}

TEST_CASE("spherical coordinates become Cartesian ones, and invalid ones are dropped") {
    E57Scan scan;
    const double pi = 3.14159265358979323846;
    scan.fields = {doubleField("sphericalRange", {2, 2, 5, 9}),
                   doubleField("sphericalAzimuth", {0, pi / 2, pi, 0}),
                   doubleField("sphericalElevation", {0, pi / 6, -pi / 2, 0}),
                   integerField("sphericalInvalidState", 0, 2, {0, 0, 0, 1})};
    scan.xml = cat("<pose>", translationXml("1", "2", "3"), "</pose>");
    E57Points read = readE57({{scan}, ""});
    std::vector<Vec3d> expected{{3, 2, 3}, {1, 2 + std::sqrt(3.0), 4}, {1, 2, -2}};
    REQUIRE(read.points.size() == 3);
    for (std::size_t i = 0; i < 3; ++i)
        for (int axis = 0; axis < 3; ++axis)
            CHECK(std::abs(read.world()[i][axis] - expected[i][axis]) <= 0.51e-8);
    CHECK(read.report.invalid == 1);
    CHECK(read.description.grid.scale.x == 1e-8); // 10^-9 of the extent, as a power of ten
    CHECK(read.report.maxRounding <= 0.5e-8);
}

TEST_CASE("points of Cartesian and spherical coordinates are where the Cartesian ones are") {
    E57Scan scan = gridScan(3);
    scan.fields.push_back(floatField("sphericalRange", {1, 2, 3}));
    E57Points read = readE57({{scan}, ""});
    CHECK(stored(read, 0) == decoded(scan.fields[0], -500000));
    CHECK(read.values<float>("sphericalRange") == std::vector<float>{1, 2, 3});
}

TEST_CASE("integers farther out than any grid could count are dropped and counted") {
    E57Scan scan;
    std::int64_t low = std::numeric_limits<std::int64_t>::min(),
                 high = std::numeric_limits<std::int64_t>::max();
    scan.fields = {integerField("cartesianX", low, high, {5, high, -7}),
                   integerField("cartesianY", low, high, {1, 2, low}),
                   integerField("cartesianZ", low, high, {1, 2, 3})};
    E57Points read = readE57({{scan}, ""});
    CHECK(read.points.positions == std::vector<Vec3i>{{5, 1, 1}});
    CHECK(read.description.grid.scale.x == 1);
    CHECK(read.report.outOfRange == 2);
}

TEST_CASE("stated bounds are taken at their word, and contradicted by the points") {
    E57Scan scan = gridScan(20);
    auto bounds = [](const char* xMax) {
        return cat("<cartesianBounds><xMinimum type=\"Float\">-500</xMinimum><xMaximum type=\"Float\">", xMax,
                   "</xMaximum><yMinimum>-500</yMinimum><yMaximum>500</yMaximum><zMinimum>-500</zMinimum>"
                   "<zMaximum>500</zMaximum></cartesianBounds>");
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
        scan.fields[axis].codes[0] = 0;
        scan.fields[axis].codes[1] = 1000000;
    }
    TemporaryFolder folder;
    for (bool lies : {false, true}) {
        scan.xml = bounds(lies ? "400" : "500");
        auto input = openE57Input(writeBytes(folder.file("a.e57"), E57File{{scan}, ""}.bytes()));
        REQUIRE(input.ok());
        CHECK(!(*input)->description().boundsAreMeasured);
        CHECK((*input)->description().bounds.max == Vec3i{lies ? 400000 : 500000, 500000, 500000});
        BoxI found;
        found.extend(Vec3i{-500000, -500000, -500000});
        found.extend(Vec3i{500000, 500000, 500000});
        CHECK((*input)->contradiction(found).has_value() == lies);
    }
}

TEST_CASE("a scan of no records is an input of no points") {
    E57Points read = readE57({{gridScan(0)}, ""});
    CHECK(read.points.size() == 0);
    CHECK(read.parts.empty());
}
