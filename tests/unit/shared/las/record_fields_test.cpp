// Each field of each point format, laid out here by hand from the tables of the specification.
#include "tests/unit/shared/las/las_bytes.hpp"

#include <limits>
#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {

const double gpsTime = -123456.789;

bool hasTime(int format) {
    return format != 0 && format != 2;
}
bool hasColour(int format) {
    return format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
}
bool hasNir(int format) {
    return format == 8 || format == 10;
}
bool hasWave(int format) {
    return format == 4 || format == 5 || format == 9 || format == 10;
}

Bytes record(int format) {
    ByteWriter to;
    to.write(std::int32_t{-1});
    to.write(std::numeric_limits<std::int32_t>::max());
    to.write(std::numeric_limits<std::int32_t>::min());
    to.write(std::uint16_t{0xBEEF});
    if (format < 6) {
        to.write(std::uint8_t{0b1'0'101'011}); // edge, direction, number of returns, return number
        to.write(std::uint8_t{0b1'0'1'10110}); // withheld, key-point, synthetic, classification
        to.write(std::int8_t{-90});
        to.write(std::uint8_t{200});
    } else {
        to.write(std::uint8_t{0b1111'1010}); // number of returns, return number
        to.write(
            std::uint8_t{0b0'1'10'1'0'1'0}); // edge, direction, channel, overlap, withheld, key, synthetic
        to.write(std::uint8_t{201});
        to.write(std::uint8_t{202});
        to.write(std::int16_t{-30000});
    }
    to.write(std::uint16_t{54321});
    if (hasTime(format))
        to.write(gpsTime);
    if (hasColour(format)) {
        to.write(std::uint16_t{1});
        to.write(std::uint16_t{256});
        to.write(std::uint16_t{65535});
    }
    if (hasNir(format))
        to.write(std::uint16_t{777});
    if (hasWave(format)) {
        to.write(std::uint8_t{9});
        to.write(std::uint64_t{0x0123456789ABCDEF});
        to.write(std::uint32_t{4000000000});
        to.write(1.5f);
        to.write(-2.5f);
        to.write(3.5f);
        to.write(-4.5f);
    }
    return to.take();
}

std::map<std::string, double> expectedValues(int format) {
    std::map<std::string, double> values{{"Intensity", 0xBEEF}, {"Point Source ID", 54321}};
    if (format < 6)
        values.insert({{"Return Number", 3},
                       {"Number of Returns", 5},
                       {"Scan Direction Flag", 0},
                       {"Edge of Flight Line", 1},
                       {"Classification", 22},
                       {"Synthetic", 1},
                       {"Key-point", 0},
                       {"Withheld", 1},
                       {"Scan Angle Rank", -90},
                       {"User Data", 200}});
    else
        values.insert({{"Return Number", 10},
                       {"Number of Returns", 15},
                       {"Synthetic", 0},
                       {"Key-point", 1},
                       {"Withheld", 0},
                       {"Overlap", 1},
                       {"Scanner Channel", 2},
                       {"Scan Direction Flag", 1},
                       {"Edge of Flight Line", 0},
                       {"Classification", 201},
                       {"User Data", 202},
                       {"Scan Angle", -30000}});
    if (hasTime(format))
        values["GPS Time"] = gpsTime;
    if (hasColour(format))
        values.insert({{"Red", 1}, {"Green", 256}, {"Blue", 65535}});
    if (hasNir(format))
        values["NIR"] = 777;
    if (hasWave(format))
        values.insert({{"Wave Packet Descriptor Index", 9},
                       {"Byte Offset to Waveform Data", static_cast<double>(0x0123456789ABCDEF)},
                       {"Waveform Packet Size", 4e9},
                       {"Return Point Waveform Location", 1.5},
                       {"Parametric dx", -2.5},
                       {"Parametric dy", 3.5},
                       {"Parametric dz", -4.5}});
    return values;
}

double valueAsDouble(const PointBatch& points, const Schema& schema, int a) {
    switch (schema.attributes[static_cast<std::size_t>(a)].type) {
    case AttributeType::u8:
        return points.value<std::uint8_t>(a, 0);
    case AttributeType::i8:
        return points.value<std::int8_t>(a, 0);
    case AttributeType::u16:
        return points.value<std::uint16_t>(a, 0);
    case AttributeType::i16:
        return points.value<std::int16_t>(a, 0);
    case AttributeType::u32:
        return points.value<std::uint32_t>(a, 0);
    case AttributeType::u64:
        return static_cast<double>(points.value<std::uint64_t>(a, 0));
    case AttributeType::f32:
        return static_cast<double>(points.value<float>(a, 0));
    case AttributeType::f64:
        return points.value<double>(a, 0);
    default:
        FAIL("no LAS field has this type");
        return 0;
    }
}

} // namespace

TEST_CASE("every field of every point format has its LAS name and value") {
    for (int format = 0; format <= 10; ++format) {
        CAPTURE(format);
        Bytes bytes = record(format);
        REQUIRE(bytes.size() == las::pointRecordSize(format));
        LasContents las = requireLas(lasBytes({4, format, 1}, bytes));
        REQUIRE(las.points.size() == 1);
        CHECK(las.points.positions[0] == Vec3i{-1, 2147483647, -2147483648ll});
        CHECK(las.schema == las::schemaOf(format));
        auto expected = expectedValues(format);
        REQUIRE(las.schema.attributes.size() == expected.size());
        for (const auto& [name, value] : expected) {
            CAPTURE(name);
            int a = las.schema.find(name);
            REQUIRE(a >= 0);
            CHECK(valueAsDouble(las.points, las.schema, a) == value);
        }
    }
}

TEST_CASE("a GPS time keeps its bits, also those of a NaN with a payload") {
    Bytes bytes = record(1);
    std::uint64_t bits = 0x7FF4DEADBEEF0001;
    storeLe(bytes.data() + 20, bits);
    LasContents las = requireLas(lasBytes({2, 1, 1}, bytes));
    CHECK(las.points.value<std::uint64_t>(las.schema.find("GPS Time"), 0) == bits);
}

TEST_CASE("scan angles say how they are scaled") {
    Schema schema = las::schemaOf(6);
    const Attribute& angle = schema.attributes[static_cast<std::size_t>(schema.find("Scan Angle"))];
    CHECK(angle.type == AttributeType::i16);
    CHECK(angle.scale == 0.006);
    CHECK(angle.unit == "deg");
    schema = las::schemaOf(3);
    CHECK(schema.attributes[static_cast<std::size_t>(schema.find("Scan Angle Rank"))].type ==
          AttributeType::i8);
}

TEST_CASE("parts of a file are read by their number, and cut at its end") {
    LasRecipe recipe{2, 3, 100};
    Bytes bytes = lasBytes(recipe);
    LasContents all = requireLas(bytes);
    MemorySource source(bytes);
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    PointBatch part;
    REQUIRE((*reader)->read(90, 50, part).ok());
    REQUIRE(part.size() == 10);
    for (std::size_t i = 0; i < 10; ++i)
        CHECK(part.positions[i] == all.points.positions[90 + i]);
    REQUIRE((*reader)->read(100, 1, part).ok());
    CHECK(part.size() == 0);
    Status beyond = (*reader)->read(101, 1, part);
    REQUIRE(!beyond.ok());
    CHECK(beyond.error().code == ErrorCode::outOfRange);
}
