// Coordinates from one system to another, against formulas and definitions that need no PROJ.
#include "converter/crs/crs.hpp"
#include "converter/crs/transformation.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <thread>

using namespace stipple;

namespace {
constexpr double pi = 3.14159265358979323846;

Crs crs(const std::string& text) {
    auto found = crsFromUser(text);
    if (!found)
        FAIL(found.error().sentence());
    return *found;
}

std::shared_ptr<const CrsTransformation> transformation(const std::string& from, const std::string& to,
                                                        const BoxD& area = {}) {
    auto made = CrsTransformation::create(crs(from), crs(to), area);
    if (!made)
        FAIL(made.error().sentence());
    return *made;
}

Vec3d transformed(const CrsTransformation& by, Vec3d p) {
    auto transformer = by.transformer();
    REQUIRE(transformer.ok());
    (*transformer)->transform(&p.x, &p.y, &p.z, 1);
    return p;
}
} // namespace

TEST_CASE("longitude is x and latitude y, whatever the definition has first", "[transformation]") {
    // Web Mercator's formula is on a sphere: x = R λ, y = R ln tan(π/4 + φ/2).
    auto mercator = transformation("EPSG:4326", "EPSG:3857");
    constexpr double radius = 6378137, longitude = 11.5, latitude = 48.25;
    Vec3d p = transformed(*mercator, {longitude, latitude, 520});
    CHECK(p.x == Approx(radius * longitude * pi / 180).epsilon(1e-12));
    CHECK(p.y == Approx(radius * std::log(std::tan(pi / 4 + latitude * pi / 360))).epsilon(1e-12));
    CHECK(p.z == 520);
    CHECK(mercator->facts().accuracyMeters == 0.0);
    CHECK(mercator->facts().keepsHeights);
    CHECK_FALSE(mercator->facts().isBallpark);
    // Gauss-Krüger zone 3 has northing first in its definition; its central meridian is 9° east.
    Vec3d central = transformed(*transformation("EPSG:4314", "EPSG:31467"), {9, 0, 0});
    CHECK(central.x == Approx(3500000).margin(1e-6));
    CHECK(central.y == Approx(0).margin(1e-6));
}

TEST_CASE("a transformation states PROJ's accuracy", "[transformation]") {
    BoxD oregon;
    oregon.extend(Vec3d{494000, 4877000, 100});
    oregon.extend(Vec3d{495000, 4878000, 200});
    auto datums = transformation("EPSG:26910", "EPSG:4326", oregon);
    REQUIRE(datums->facts().accuracyMeters);
    CHECK(*datums->facts().accuracyMeters > 0);
    CHECK(datums->facts().operation.find("NAD83 to WGS 84") != std::string::npos);
    // There is no grid for this shift of datum on a Debian system.
    auto ballpark = transformation("EPSG:4152", "EPSG:4269", oregon);
    CHECK(ballpark->facts().isBallpark);
    CHECK_FALSE(ballpark->facts().accuracyMeters);
}

TEST_CASE("the area decides which operation is the best", "[transformation]") {
    BoxD alaska, florida;
    alaska.extend(Vec3d{-150, 61, 0});
    florida.extend(Vec3d{-82, 28, 0});
    CHECK(transformation("EPSG:4267", "EPSG:4326", alaska)->facts().operation !=
          transformation("EPSG:4267", "EPSG:4326", florida)->facts().operation);
}

TEST_CASE("heights are transformed where both systems define them, and kept elsewhere", "[transformation]") {
    SECTION("from US survey feet to metres") {
        auto heights = transformation("EPSG:6339+6360", "EPSG:6339+5703");
        CHECK_FALSE(heights->facts().keepsHeights);
        Vec3d p = transformed(*heights, {500000, 4000000, 1000});
        CHECK(p.x == Approx(500000).margin(1e-6));
        CHECK(p.z == Approx(1000 * 12 / 39.37).epsilon(1e-12));
    }
    SECTION("kept where one side has none") {
        for (auto [from, to] : {std::pair{"EPSG:6339+6360", "EPSG:6318"},
                                {"EPSG:6339", "EPSG:6318+6360"},
                                {"EPSG:6319", "EPSG:6339"}}) {
            CAPTURE(from, to);
            auto flat = transformation(from, to);
            CHECK(flat->facts().keepsHeights);
            Vec3d place =
                std::string(from) == "EPSG:6319" ? Vec3d{-123, 40, 77.125} : Vec3d{500000, 4e6, 77.125};
            CHECK(transformed(*flat, place).z == 77.125);
        }
    }
    SECTION("geocentric coordinates") {
        // On the equator, 100 m above the ellipsoid.
        auto out = transformation("EPSG:4326", "EPSG:4978");
        CHECK_FALSE(out->facts().keepsHeights);
        Vec3d p = transformed(*out, {90, 0, 100});
        CHECK(p.x == Approx(0).margin(1e-6));
        CHECK(p.y == Approx(6378237).epsilon(1e-12));
        CHECK(p.z == Approx(0).margin(1e-6));
        Vec3d back = transformed(*transformation("EPSG:4978", "EPSG:4326"), p);
        CHECK(back.x == Approx(90).epsilon(1e-12));
        CHECK(back.z == Approx(100).margin(1e-6));
    }
}

TEST_CASE("what can't be transformed becomes infinite, its neighbours do not", "[transformation]") {
    auto mercator = transformation("EPSG:4326", "EPSG:32632");
    auto transformer = mercator->transformer();
    REQUIRE(transformer.ok());
    double x[] = {9, 9, NAN, 9, INFINITY, 9}, y[] = {48, 100, 48, 48, 48, 0}, z[] = {1, 2, 3, NAN, 5, 6};
    (*transformer)->transform(x, y, z, 6);
    CHECK(std::isfinite(x[0]));
    for (int i : {1, 2, 3, 4}) {
        CAPTURE(i);
        CHECK(std::isinf(x[i]));
        CHECK(std::isinf(y[i]));
        CHECK(std::isinf(z[i]));
    }
    CHECK(x[5] == Approx(500000).epsilon(1e-12));
}

TEST_CASE("threads transform alike", "[transformation]") {
    auto utm = transformation("EPSG:4267", "EPSG:32610");
    constexpr std::size_t count = 5000;
    std::vector<std::vector<double>> results(4);
    std::vector<std::thread> threads;
    for (std::vector<double>& xs : results)
        threads.emplace_back([&] {
            auto transformer = utm->transformer();
            if (!transformer)
                return;
            std::vector<double> ys(count), zs(count);
            xs.resize(count);
            for (std::size_t i = 0; i < count; ++i) {
                xs[i] = -124 + static_cast<double>(i) / 5000;
                ys[i] = 40 + static_cast<double>(i) / 10000;
            }
            (*transformer)->transform(xs.data(), ys.data(), zs.data(), count);
        });
    for (std::thread& thread : threads)
        thread.join();
    CHECK(results[0].size() == count);
    for (const std::vector<double>& xs : results)
        CHECK(xs == results[0]);
}

TEST_CASE("systems without a way between them are refused with both names", "[transformation]") {
    Crs local;
    local.name = "site";
    local.wkt = "LOCAL_CS[\"site\",UNIT[\"metre\",1]]";
    auto refused = CrsTransformation::create(local, crs("EPSG:4326"), {});
    REQUIRE(!refused.ok());
    CHECK(refused.error().sentence().find("site") != std::string::npos);
    Crs broken;
    broken.wkt = "no WKT";
    CHECK(CrsTransformation::create(crs("EPSG:4326"), broken, {}).error().code == ErrorCode::unsupported);
}
