// Real and odd files of other software. The checksums were made by a separate program from the tables of
// the specification: a value of the k-th field of the i-th point (both from 1, X first, as in the record;
// floats by their bits) counts i × k, the j-th extra byte 1000 × i × j, all modulo 2^64.
#include "shared/io/file_source.hpp"
#include "tests/support/data.hpp"
#include "tests/unit/shared/las/las_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

struct RealFile {
    const char* name;
    int versionMinor, pointFormat;
    std::size_t points;
    std::uint64_t checksum;
};

constexpr RealFile files[] = {
    {"las-pairs/1815.las", 2, 1, 1247, 0x50D0F8104E9EBCD2},
    {"las-pairs/autzen_trim.las", 2, 3, 110000, 0x28D5CE5F6ED71D8A},
    {"las-pairs/extrabytes.las", 2, 3, 1065, 0x230F09B8D0B273EA},
    {"las-pairs/no-points-1.3.las", 3, 0, 0, 0x0000000000000000},
    {"las-pairs/pdrf10-1.4.las", 4, 10, 1024, 0xB4ECC7E581C8EE8D},
    {"las-pairs/pdrf4-1.3.las", 3, 4, 1024, 0x76D55B653F18B0D5},
    {"las-pairs/pdrf5-1.3.las", 3, 5, 1024, 0xB27C7F042B0F516B},
    {"las-pairs/pdrf6-1.4.las", 4, 6, 1024, 0x64DB55F80424037E},
    {"las-pairs/pdrf7-v4-1.4.las", 4, 7, 1024, 0xA0817B80A6EEA985},
    {"las-pairs/pdrf8-1.4.las", 4, 8, 1024, 0x0E20789E60BDF086},
    {"las-pairs/pdrf9-1.4.las", 4, 9, 1024, 0x4537CAA203EB3679},
    {"las-pairs/point-color-time.las", 2, 3, 1065, 0x23109D56AAEE2685},
    {"las-pairs/point-color.las", 2, 2, 1065, 0x0002115244E8D394},
    {"las-pairs/point-time.las", 2, 1, 1065, 0x23109D55C32BE0B5},
    {"las-pairs/point10-1.0.las", 0, 0, 1, 0x0000000000000149},
    {"las-pairs/point10-1.1.las", 1, 0, 1, 0x00000000000001FF},
    {"las-pairs/point10.las", 2, 0, 1065, 0x000211516A051265},
    {"las-pairs/rand1_6.las", 4, 6, 50000, 0x62714B90B51D9BED},
    {"las-odd/autzen_trim_7.las", 4, 7, 110000, 0x8B7C78B2419DF81C},
    {"las-odd/bad-geotiff-keys.las", 0, 1, 10, 0xD8C9F8A0D54B0652},
    {"las-odd/bad_vlr_count.las", 2, 3, 10, 0xD8C9F8A0D54B0652},
    {"las-odd/gps-time-nan.las", 2, 1, 1, 0xFF80000000000000},
    {"las-odd/lots_of_vlr.las", 1, 1, 1, 0x10B12537F88A866A},
    {"las-odd/sample_nc.las", 2, 3, 14408, 0xDE0DC663233F65B7},
    {"las-odd/spurious.las", 2, 3, 1065, 0x230DD7A74099C9EE},
    {"las-odd/test_epsg_4326.las", 2, 3, 10, 0xD8C9F89575AA84D0},
    {"las-odd/utm15.las", 2, 3, 1, 0x1D1F827779AD5488},
};

std::uint64_t valueBits(const Bytes& column, AttributeType type, std::size_t i) {
    auto widened = [&](auto zero) {
        auto value = loadLe<decltype(zero)>(column.data() + i * sizeof zero);
        if constexpr (std::is_signed_v<decltype(zero)>)
            return static_cast<std::uint64_t>(static_cast<std::int64_t>(value));
        else
            return static_cast<std::uint64_t>(value);
    };
    switch (type) {
    case AttributeType::u8:
        return widened(std::uint8_t{});
    case AttributeType::i8:
        return widened(std::int8_t{});
    case AttributeType::u16:
        return widened(std::uint16_t{});
    case AttributeType::i16:
        return widened(std::int16_t{});
    case AttributeType::u32:
    case AttributeType::f32:
        return widened(std::uint32_t{});
    default:
        return widened(std::uint64_t{});
    }
}

std::uint64_t checksum(const LasContents& las) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < las.points.size(); ++i)
        for (std::size_t axis = 0; axis < 3; ++axis)
            sum += (i + 1) * (axis + 1) *
                   static_cast<std::uint64_t>(las.points.positions[i][static_cast<int>(axis)]);
    std::size_t baseCount = las::schemaOf(las.header.pointFormat).attributes.size();
    std::uint64_t extraSum = 0;
    std::size_t extraByte = 0;
    for (std::size_t a = 0; a < las.schema.attributes.size(); ++a) {
        const Attribute& attribute = las.schema.attributes[a];
        const Bytes& column = las.points.columns[a];
        if (a < baseCount) {
            for (std::size_t i = 0; i < las.points.size(); ++i)
                sum += (i + 1) * (a + 4) * valueBits(column, attribute.type, i);
            continue;
        }
        for (std::size_t at = 0; at < column.size(); ++at)
            extraSum += (at / attribute.size() + 1) * (extraByte + at % attribute.size() + 1) * column[at];
        extraByte += attribute.size();
    }
    return sum + 1000 * extraSum;
}

LasContents readFile(const std::string& name) {
    auto source = openFileSource(dataPath(name));
    REQUIRE(source.ok());
    auto contents = readLas(**source);
    if (!contents.ok())
        FAIL(contents.error().sentence());
    return std::move(*contents);
}

BoxI boxOf(const PointBatch& points) {
    BoxI box;
    for (Vec3i p : points.positions)
        box.extend(p);
    return box;
}

} // namespace

TEST_CASE("files of other software are read to the last bit, and survive a round trip") {
    STIPPLE_NEEDS_DATA();
    for (const RealFile& file : files) {
        CAPTURE(file.name);
        LasContents las = readFile(file.name);
        CHECK(las.header.versionMinor == file.versionMinor);
        CHECK(las.header.pointFormat == file.pointFormat);
        CHECK(las.points.size() == file.points);
        CHECK(checksum(las) == file.checksum);
        requireRoundTrip(fileBytes(dataPath(file.name)));
    }
}

TEST_CASE("only the odd files give warnings, and only theirs") {
    STIPPLE_NEEDS_DATA();
    for (const RealFile& file : files) {
        CAPTURE(file.name);
        bool odd = std::string(file.name) == "las-odd/bad_vlr_count.las";
        CHECK(readFile(file.name).warnings.size() == (odd ? 1 : 0));
    }
}

TEST_CASE("bad_vlr_count: a third record is counted, but the points begin after two") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/bad_vlr_count.las");
    CHECK(las.header.vlrs.size() == 2);
    CHECK(las.warnings[0] == "byte 429: the header counts 3 variable length records, but only 2 lie before "
                             "the points");
}

TEST_CASE("lots_of_vlr: 390 records for one point") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/lots_of_vlr.las");
    CHECK(las.header.vlrs.size() == 390);
    CHECK(las.header.vlrs[0].userId == "Merrick");
    CHECK(las.header.vlrs[0].data.size() == 342);
    CHECK(las.header.vlrs.back().offsetBytes + las.header.vlrs.back().data.size() == 81891);
}

TEST_CASE("gps-time-nan: the time is a NaN and stays one") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/gps-time-nan.las");
    CHECK(std::isnan(las.points.value<double>(las.schema.find("GPS Time"), 0)));
}

TEST_CASE("spurious: the header's bounds leave points out") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/spurious.las");
    CHECK(las::boundsContradiction(las.header, boxOf(las.points)).value() ==
          "the header gives x from -123.0749695 to -123.0625001, but the points lie from -124.0687348 to "
          "-123.0625001");
}

TEST_CASE("bad-geotiff-keys: LAS 1.0, whose signature lies between the records and the points") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/bad-geotiff-keys.las");
    CHECK(las.header.pointDataOffset == 759);
    CHECK(las.header.vlrs.back().offsetBytes + las.header.vlrs.back().data.size() == 757);
    Vec3d first = las.header.grid.toWorld(las.points.positions[0]);
    CHECK(first.x == Approx(289814.15).margin(0.005));
    CHECK(first.y == Approx(4320978.61).margin(0.005));
}

TEST_CASE("utm15 and pdrf7: counts where the specification does not want them") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-odd/utm15.las");
    CHECK(las.header.pointsByReturn[1] == 1);
    CHECK(las.points.value<std::uint8_t>(las.schema.find("Return Number"), 0) == 2);
    las = readFile("las-pairs/pdrf7-v4-1.4.las"); // the legacy count is 0, as it should be
    CHECK(las.points.size() == 1024);
    CHECK(las.header.pointsByReturn[12] == 5);
}

TEST_CASE("extrabytes: tuples, bytes without a type, and a name that LAS has taken") {
    STIPPLE_NEEDS_DATA();
    LasContents las = readFile("las-pairs/extrabytes.las");
    auto attribute = [&](const char* name) {
        int a = las.schema.find(name);
        REQUIRE(a >= 0);
        return las.schema.attributes[static_cast<std::size_t>(a)];
    };
    CHECK(attribute("Colors").components == 3);
    CHECK(attribute("Colors").type == AttributeType::u16);
    CHECK(attribute("Reserved").components == 7);
    CHECK(attribute("Flags").components == 2);
    CHECK(attribute("Flags").type == AttributeType::i8);
    CHECK(attribute("Intensity 2").description == "Brightness");
    CHECK(attribute("Time").type == AttributeType::u64);
    // The file repeats its fields in its extra bytes.
    CHECK(las.points.value<std::uint32_t>(las.schema.find("Intensity 2"), 0) ==
          las.points.value<std::uint16_t>(las.schema.find("Intensity"), 0));
}

TEST_CASE("bounds in the header agree with the points in all files but one") {
    STIPPLE_NEEDS_DATA();
    for (const RealFile& file : files) {
        CAPTURE(file.name);
        LasContents las = readFile(file.name);
        bool lies = std::string(file.name) == "las-odd/spurious.las";
        CHECK(las::boundsContradiction(las.header, boxOf(las.points)).has_value() == lies);
    }
}
