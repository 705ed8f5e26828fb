// Coordinate systems from WKT records, GeoTIFF keys (sound and broken) and users' text.
#include "converter/crs/crs.hpp"
#include "shared/io/file_source.hpp"
#include "shared/las/las_reader.hpp"
#include "tests/support/data.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <random>

using namespace stipple;
using namespace stipple::test;

namespace {

using Numbers = std::vector<std::uint16_t>;

las::Vlr projectionRecord(std::uint16_t id, Bytes data) {
    return {"LASF_Projection", id, "", std::move(data)};
}

las::Vlr keyRecord(const Numbers& numbers) {
    Bytes data(2 * numbers.size());
    std::memcpy(data.data(), numbers.data(), data.size());
    return projectionRecord(34735, std::move(data));
}
las::Vlr doublesRecord(const std::vector<double>& values) {
    Bytes data(8 * values.size());
    std::memcpy(data.data(), values.data(), data.size());
    return projectionRecord(34736, std::move(data));
}
las::Vlr textRecord(std::uint16_t id, const std::string& text) {
    return projectionRecord(id, Bytes(text.begin(), text.end()));
}

// Keys given as groups of four numbers, without the directory's own first four.
las::Header headerWithKeys(const Numbers& keys) {
    las::Header header;
    header.versionMinor = 2;
    Numbers directory{1, 1, 0, static_cast<std::uint16_t>(keys.size() / 4)};
    directory.insert(directory.end(), keys.begin(), keys.end());
    header.vlrs = {keyRecord(directory)};
    return header;
}

CrsReading requireReading(const las::Header& header) {
    auto reading = crsOfLas(header);
    if (!reading.ok())
        FAIL(reading.error().sentence());
    return *reading;
}

CrsReading readingOf(const std::string& file) {
    auto source = openFileSource(dataPath(file));
    REQUIRE(source.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    return requireReading((*reader)->header());
}

bool anyContains(const std::vector<std::string>& sentences, const std::string& part) {
    for (const std::string& sentence : sentences)
        if (sentence.find(part) != std::string::npos)
            return true;
    return false;
}

std::string wktOf(const std::string& text) {
    auto crs = crsFromUser(text);
    REQUIRE(crs.ok());
    return crs->wkt;
}

} // namespace

TEST_CASE("a projected system is found by its code in the keys") {
    CrsReading reading = requireReading(headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26910}));
    CHECK(reading.warnings.empty());
    CHECK(reading.crs.name == "NAD83 / UTM zone 10N");
    CHECK(reading.crs.epsg == 26910);
    CHECK(reading.crs.unit == "metre");
    CHECK(reading.crs.unitMeters == 1);
    CHECK(reading.crs.proj == "+proj=utm +zone=10 +datum=NAD83 +units=m +no_defs +type=crs");
    CHECK(reading.crs.wkt.find("PROJCS[\"NAD83 / UTM zone 10N\"") == 0);
}

TEST_CASE("a geographic system has angular units and no size in metres") {
    Crs crs = requireReading(headerWithKeys({1024, 0, 1, 2, 2048, 0, 1, 4326})).crs;
    CHECK(crs.epsg == 4326);
    CHECK(crs.unit == "degree");
    CHECK(crs.unitMeters == 0);
}

TEST_CASE("a vertical system in the keys makes a compound one") {
    Crs crs = requireReading(headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 6580, 4096, 0, 1, 5703})).crs;
    CHECK(crs.name == "NAD83(2011) / Texas Centric Lambert Conformal + NAVD88 height");
    CHECK(crs.wkt.find("COMPD_CS[") == 0);
    CHECK(crs.epsg == 6580);
    // A code that is no vertical system is left out.
    CrsReading odd = requireReading(headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 6580, 4096, 0, 1, 4326}));
    CHECK(odd.crs.epsg == 6580);
    CHECK(odd.crs.wkt.find("PROJCS[") == 0);
    CHECK(anyContains(odd.warnings, "vertical system EPSG:4326"));
}

TEST_CASE("a linear unit in the keys replaces that of the code") {
    Crs crs = requireReading(headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26910, 3076, 0, 1, 9003})).crs;
    CHECK(crs.unit == "US survey foot");
    CHECK(crs.unitMeters == Approx(1200.0 / 3937).epsilon(1e-12));
    CHECK(!crs.epsg);
    CHECK(crs.proj.find("+units=us-ft") != std::string::npos);
}

TEST_CASE("a system spelled out by parameters is understood") {
    las::Header header =
        headerWithKeys({1024, 0,     1, 1, 2048, 0,     1, 4269, 3072, 0,     1, 32767, 3074, 0,     1, 32767,
                        3075, 0,     1, 1, 3076, 0,     1, 9001, 3080, 34736, 1, 1,     3081, 34736, 1, 0,
                        3082, 34736, 1, 3, 3083, 34736, 1, 4,    3092, 34736, 1, 2,     1026, 34737, 9, 0});
    header.vlrs.push_back(doublesRecord({24.5, -81, 0.9999, 200000, 0}));
    header.vlrs.push_back(textRecord(34737, "My grid |x"));
    CrsReading reading = requireReading(header);
    CHECK(reading.warnings.empty());
    CHECK(reading.crs.proj == "+proj=tmerc +lat_0=24.5 +lon_0=-81 +k=0.9999 +x_0=200000 +y_0=0 +datum=NAD83 "
                              "+units=m +no_defs +type=crs");
    CHECK(reading.crs.name.find("My grid") == 0);
    CHECK(reading.crs.unitMeters == 1);
}

TEST_CASE("broken keys give warnings, and what is sound still counts") {
    // Padding, a reference to text that is not there, one to doubles out of range, a doubled key.
    CrsReading reading =
        requireReading(headerWithKeys({1024, 0, 1, 1, 1026, 34737, 20, 0,     2057, 34736, 1, 7,
                                       0,    0, 0, 0, 3072, 0,     1,  32617, 3072, 0,     1, 32618}));
    CHECK(reading.crs.epsg == 32617);
    CHECK(anyContains(reading.warnings, "key 4 of 6 is empty"));
    CHECK(anyContains(reading.warnings, "GeoTIFF key 1026 refers to 20 values"));
    CHECK(anyContains(reading.warnings, "GeoTIFF key 2057 refers to 1 values from 7"));
    CHECK(anyContains(reading.warnings, "more than once"));

    las::Header header;
    header.versionMinor = 2;
    header.vlrs = {keyRecord({1, 1, 0, 500, 1024, 0, 1, 1, 3072, 0, 1, 32617})};
    reading = requireReading(header);
    CHECK(reading.crs.epsg == 32617);
    CHECK(anyContains(reading.warnings, "counts 500 keys, but holds 2"));
    header.vlrs = {keyRecord({7, 7, 7, 7})};
    reading = requireReading(header);
    CHECK(!reading.crs.known());
    CHECK(anyContains(reading.warnings, "does not begin with version 1"));
    header.vlrs = {projectionRecord(34735, {1, 0, 1})};
    CHECK(!requireReading(header).crs.known());
}

TEST_CASE("codes nobody knows leave the system unknown, with a sentence") {
    CrsReading reading = requireReading(headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 30001}));
    CHECK(!reading.crs.known());
    CHECK(anyContains(reading.warnings, "EPSG:30001, which PROJ does not know"));
    reading = requireReading(headerWithKeys({1024, 0, 1, 2, 2048, 0, 1, 1}));
    CHECK(!reading.crs.known());
    CHECK(anyContains(reading.warnings, "EPSG:1,"));
}

TEST_CASE("geocentric keys are believed only where the coordinates are on the Earth") {
    las::Header header = headerWithKeys({1024, 0, 1, 3, 2048, 0, 1, 4326});
    header.bounds.min = header.bounds.max = {6378000, 100, 100};
    CrsReading reading = requireReading(header);
    CHECK(reading.warnings.empty());
    CHECK(reading.crs.name == "WGS 84 (geocentric)");
    CHECK(reading.crs.unitMeters == 1);
    CHECK(reading.crs.proj.find("+proj=geocent") == 0);
    header.bounds.min = header.bounds.max = {500000, 4900000, 100};
    reading = requireReading(header);
    CHECK(!reading.crs.known());
    CHECK(anyContains(reading.warnings, "km from the Earth's centre"));
}

TEST_CASE("the bit of LAS 1.4 decides between WKT and keys; without it a code in the keys holds") {
    las::Header header = headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26910});
    std::string wkt = wktOf("EPSG:2154");
    header.vlrs.push_back(textRecord(2112, wkt + std::string(1, '\0')));
    header.vlrs.push_back(textRecord(2111, "PARAM_MT[\"Affine\"]"));
    CHECK(requireReading(header).crs.epsg == 26910);
    header.versionMinor = 4;
    CHECK(requireReading(header).crs.epsg == 26910);
    header.globalEncoding = 16;
    Crs crs = requireReading(header).crs;
    CHECK(crs.epsg == 2154);
    CHECK(crs.wkt == wkt);
}

TEST_CASE("broken WKT is a warning, and the keys stand in") {
    las::Header header = headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26910});
    header.versionMinor = 4;
    header.globalEncoding = 16;
    for (std::string wkt : {"PROJCS[", "nonsense", "PROJCS[\"a\",GEOGCS[\"b\"]]", "\xFF\xFE"}) {
        header.vlrs.resize(1);
        header.vlrs.push_back(textRecord(2112, wkt));
        CrsReading reading = requireReading(header);
        CHECK(reading.crs.epsg == 26910);
        CHECK(anyContains(reading.warnings, "does not understand the WKT"));
    }
    header.vlrs[1].data.assign(2'000'000, '[');
    CHECK(anyContains(requireReading(header).warnings, "too long"));
    header.vlrs.erase(header.vlrs.begin());
    CHECK(!requireReading(header).crs.known());
}

TEST_CASE("WKT without a code is identified where PROJ is certain") {
    std::string wkt = wktOf("EPSG:32632");
    for (std::size_t at; (at = wkt.find(",AUTHORITY[")) != std::string::npos;)
        wkt.erase(at, wkt.find(']', at) + 1 - at);
    las::Header header;
    header.globalEncoding = 16;
    header.vlrs = {textRecord(2112, wkt)};
    Crs crs = requireReading(header).crs;
    CHECK(crs.epsg == 32632);
    CHECK(crs.wkt == wkt);
}

TEST_CASE("a file without records has no system and no warnings") {
    CrsReading reading = requireReading({});
    CHECK(reading.crs == Crs{});
    CHECK(reading.warnings.empty());
}

TEST_CASE("axes are those of the points: east first, heights where the system has them") {
    Crs utm = *crsFromUser("EPSG:6339+6360");
    CHECK(utm.vertical == "NAVD88 height (ftUS)");
    REQUIRE(utm.axes.size() == 3);
    CHECK(utm.axes[0] == CrsAxis{"Easting", "east", "metre", 1});
    CHECK(utm.axes[1] == CrsAxis{"Northing", "north", "metre", 1});
    CHECK(utm.axes[2].direction == "up");
    CHECK(utm.axes[2].unit == "US survey foot");
    CHECK(utm.axes[2].unitMeters == Approx(12 / 39.37).epsilon(1e-12));

    Crs geographic = *crsFromUser("EPSG:4326");
    CHECK(geographic.vertical.empty());
    REQUIRE(geographic.axes.size() == 2);
    CHECK(geographic.axes[0] == CrsAxis{"Geodetic longitude", "east", "degree", 0});
    CHECK(geographic.axes[1].direction == "north");
    CHECK(crsFromUser("EPSG:4978")->axes.size() == 3);
    // North comes first in the definition.
    CHECK(crsFromUser("EPSG:31467")->axes[0].direction == "east");
}

TEST_CASE("records read before are known by all that they hold") {
    las::Header utm10 = headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26910});
    las::Header utm11 = headerWithKeys({1024, 0, 1, 1, 3072, 0, 1, 26911});
    for (int round = 0; round < 2; ++round) {
        CHECK(requireReading(utm10).crs.epsg == 26910);
        CHECK(requireReading(utm11).crs.epsg == 26911);
    }
    // The same WKT record, with and without the bit that makes it hold over the keys.
    las::Header both = utm10;
    both.versionMinor = 4;
    both.vlrs.push_back(textRecord(2112, wktOf("EPSG:32633")));
    CHECK(requireReading(both).crs.epsg == 26910);
    both.globalEncoding = 16;
    CHECK(requireReading(both).crs.epsg == 32633);
    // Whether coordinates can be geocentric is asked of each file.
    las::Header geocentric = headerWithKeys({1024, 0, 1, 3, 2048, 0, 1, 4978});
    geocentric.bounds = {{4e6, 4e6, 2.85e6}, {4e6, 4e6, 2.85e6}};
    CHECK(requireReading(geocentric).crs.known());
    geocentric.bounds = {{5, 5, 5}, {6, 6, 6}};
    CHECK_FALSE(requireReading(geocentric).crs.known());
}

TEST_CASE("users name systems by code, WKT, PROJ string or name") {
    CHECK(crsFromUser("EPSG:26910")->epsg == 26910);
    CHECK(crsFromUser("EPSG:6339+5703")->name == "NAD83(2011) / UTM zone 10N + NAVD88 height");
    CHECK(crsFromUser("EPSG:6339+5703")->epsg == 6339);
    CHECK(crsFromUser("EPSG:2994")->unitMeters == Approx(0.3048).epsilon(1e-12));
    CHECK(crsFromUser("+proj=utm +zone=32 +datum=WGS84")->unit == "metre");
    CHECK(crsFromUser(wktOf("EPSG:3857"))->epsg == 3857);
    CHECK(crsFromUser("WGS 84")->epsg == 4326);
    for (const char* text : {"", "EPSG:", "EPSG:99999999", "+proj=nothing", "somewhere in Bavaria",
                             "+proj=pipeline +step +proj=axisswap +order=2,1"}) {
        CAPTURE(text);
        auto crs = crsFromUser(text);
        REQUIRE(!crs.ok());
        CHECK(crs.error().code == ErrorCode::invalidArgument);
    }
}

TEST_CASE("without PROJ's database every answer says what is missing") {
    const char* before = std::getenv("PROJ_DATA");
    std::string kept = before ? before : "";
    setenv("PROJ_DATA", "/nowhere", 1);
    setenv("PROJ_LIB", "/nowhere", 1);
    auto crs = crsFromUser("EPSG:26910");
    auto reading = crsOfLas({});
    before ? setenv("PROJ_DATA", kept.c_str(), 1) : unsetenv("PROJ_DATA");
    unsetenv("PROJ_LIB");
    REQUIRE(!crs.ok());
    CHECK(crs.error().code == ErrorCode::ioFailed);
    CHECK(crs.error().sentence().find("proj.db") != std::string::npos);
    CHECK(!reading.ok());
    CHECK(crsFromUser("EPSG:26910").ok());
}

TEST_CASE("random keys, doubles and texts never do harm") {
    std::mt19937 random(11);
    const std::uint16_t ids[] = {1024, 1025, 1026, 2048, 2049, 2050, 2052, 2054, 2055, 2056, 2057,
                                 2059, 2060, 2061, 2062, 3072, 3073, 3074, 3075, 3076, 3077, 3078,
                                 3080, 3081, 3082, 3083, 3084, 3088, 3092, 4096, 4097, 4099};
    const std::uint16_t values[] = {0, 1, 2, 3, 8, 4326, 4978, 9001, 9003, 9102, 26910, 32767, 65535};
    for (int round = 0; round < 300; ++round) {
        Numbers keys;
        for (std::uint16_t id : ids) {
            unsigned kind = random() % 4;
            std::uint16_t value = values[random() % std::size(values)];
            if (kind == 1)
                keys.insert(keys.end(), {id, 0, 1, value});
            if (kind == 2)
                keys.insert(keys.end(), {id, 34736, static_cast<std::uint16_t>(random() % 4),
                                         static_cast<std::uint16_t>(random() % 8)});
            if (kind == 3 && random() % 2 == 0)
                keys.insert(keys.end(), {id, 34737, static_cast<std::uint16_t>(random() % 40),
                                         static_cast<std::uint16_t>(random() % 20)});
        }
        las::Header header = headerWithKeys(keys);
        header.bounds.min = header.bounds.max = {0, 0, 0};
        header.vlrs.push_back(doublesRecord({0, 1, -81, 0.9996, std::nan(""), HUGE_VAL, 6378137, 298.25}));
        header.vlrs.push_back(textRecord(34737, std::string(45, 'x')));
        CrsReading reading = requireReading(header);
        CHECK((reading.crs.known() || !reading.warnings.empty()));
    }
}

TEST_CASE("the systems of real files are found") {
    STIPPLE_NEEDS_DATA();
    CHECK(readingOf("las-odd/utm15.las").crs.epsg == 26915);
    CHECK(readingOf("las-odd/test_epsg_4326.las").crs.epsg == 4326);
    CHECK(readingOf("las-odd/spurious.las").crs.epsg == 4326);
    CHECK(readingOf("las-odd/bad_vlr_count.las").crs.epsg == 32617);
    CHECK(readingOf("las-pairs/point-color-time.las").crs.epsg == 26910);
    CHECK(readingOf("las-pairs/1815.las").crs.name ==
          "NAD83(2011) / Texas Centric Lambert Conformal + NAVD88 height");
    CHECK(!readingOf("las-odd/sample_nc.las").crs.known());

    CrsReading odd = readingOf("las-odd/bad-geotiff-keys.las"); // four keys of padding
    CHECK(odd.crs.epsg == 32617);
    CHECK(odd.warnings.size() == 4);

    Crs feet = readingOf("las-odd/lots_of_vlr.las").crs; // no code, parameters only, US survey feet
    CHECK(feet.known());
    CHECK(feet.unitMeters == Approx(1200.0 / 3937).epsilon(1e-12));

    for (const char* name : {"las-pairs/autzen_trim.las", "las-odd/autzen_trim_7.las"}) {
        CrsReading autzen = readingOf(name); // WKT, though one also spells keys out
        CHECK(autzen.warnings.empty());
        CHECK(autzen.crs.name == "NAD_1983_HARN_Lambert_Conformal_Conic");
        CHECK(autzen.crs.unitMeters == Approx(0.3048).epsilon(1e-12));
        CHECK(autzen.crs.wkt.find("DATUM[\"NAD83_High") != std::string::npos);
    }
}
