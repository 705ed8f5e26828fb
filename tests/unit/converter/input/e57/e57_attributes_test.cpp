#include "tests/unit/converter/input/e57/read_all.hpp"

#include "shared/base/text.hpp"

using namespace stipple;
using namespace stipple::test;
using Catch::Matchers::Contains;

namespace {
// Coordinates of `count` points, to which tests add fields.
E57Scan scanOf(std::size_t count) {
    E57Scan scan;
    for (const char* name : {"cartesianX", "cartesianY", "cartesianZ"}) {
        std::vector<std::int64_t> values;
        for (std::size_t i = 0; i < count; ++i)
            values.push_back(static_cast<std::int64_t>(i));
        scan.fields.push_back(scaledField(name, 0, 1000, "0.001", "0", values));
    }
    return scan;
}
E57Points readWith(std::vector<E57Field> fields, const std::string& xml = "") {
    E57Scan scan = scanOf(fields[0].codes.size());
    for (E57Field& field : fields)
        scan.fields.push_back(std::move(field));
    scan.xml = xml;
    return readE57({{scan}, ""});
}
std::vector<E57Field> colour(std::int64_t max, const std::vector<std::int64_t>& red) {
    std::vector<std::int64_t> zeros(red.size(), 0);
    return {integerField("colorRed", 0, max, red), integerField("colorGreen", 0, max, zeros),
            integerField("colorBlue", 0, max, zeros)};
}
std::string colourLimits(int max) {
    std::string text;
    for (const char* name : {"Red", "Green", "Blue"})
        text += cat("<color", name, "Minimum type=\"Integer\"/><color", name, "Maximum type=\"Integer\">",
                    max, "</color", name, "Maximum>");
    return cat("<colorLimits type=\"Structure\">", text, "</colorLimits>");
}
std::string intensityLimits(const char* min, const char* max) {
    return cat("<intensityLimits type=\"Structure\"><intensityMinimum type=\"Float\">", min,
               "</intensityMinimum><intensityMaximum type=\"Float\">", max,
               "</intensityMaximum></intensityLimits>");
}
using U8 = std::vector<std::uint8_t>;
using U16 = std::vector<std::uint16_t>;
} // namespace

TEST_CASE("colours of 8 and of 16 bits are as stated") {
    E57Points read = readWith(colour(255, {0, 128, 255}), colourLimits(255));
    CHECK(read.values<std::uint16_t>("Red") == U16{0, 128, 255});
    CHECK(read.description.schema.find("colorRed") < 0);
    CHECK(readWith(colour(255, {0, 128, 255})).values<std::uint16_t>("Red") == U16{0, 128, 255});
    read = readWith(colour(65535, {0, 1234, 65535}), colourLimits(65535));
    CHECK(read.values<std::uint16_t>("Red") == U16{0, 1234, 65535});
    CHECK(read.description.schema.find("colorRed") < 0);
    // Room for 16 bits, but limits of 8.
    CHECK(readWith(colour(65535, {0, 7, 255}), colourLimits(255)).values<std::uint16_t>("Red") ==
          U16{0, 7, 255});
}

TEST_CASE("colours of other depths are stretched, and kept as stated beside") {
    E57Points read = readWith(colour(1023, {0, 512, 1023}), colourLimits(1023));
    CHECK(read.values<std::uint16_t>("Red") == U16{0, 32800, 65535});
    CHECK(read.values<std::uint16_t>("colorRed") == U16{0, 512, 1023});
    read = readWith({floatField("colorRed", {0.0f, 0.5f, 2.0f})}, colourLimits(1));
    CHECK(read.values<std::uint16_t>("Red") == U16{0, 32768, 65535});
    CHECK(read.values<float>("colorRed") == std::vector<float>{0.0f, 0.5f, 2.0f});
}

TEST_CASE("scans of 8-bit and of 16-bit colours are brought to 16 bits") {
    E57Scan a = scanOf(2), b = scanOf(2);
    for (E57Field& field : colour(255, {1, 255}))
        a.fields.push_back(field);
    for (E57Field& field : colour(65535, {1, 65535}))
        b.fields.push_back(field);
    E57Points read = readE57({{a, b}, ""});
    CHECK(read.values<std::uint16_t>("Red") == U16{257, 65535, 1, 65535});
}

TEST_CASE("marked colours, intensities and times are 0, and the marks are kept") {
    std::vector<E57Field> fields = colour(255, {9, 8, 7});
    fields.push_back(integerField("isColorInvalid", 0, 1, {0, 1, 0}));
    fields.push_back(integerField("intensity", 0, 4095, {4000, 4001, 4002}));
    fields.push_back(integerField("isIntensityInvalid", 0, 1, {1, 0, 0}));
    fields.push_back(doubleField("timeStamp", {1.5, 2.5, 3.5}));
    fields.push_back(integerField("isTimeStampInvalid", 0, 1, {0, 0, 1}));
    E57Points read = readWith(fields);
    CHECK(read.values<std::uint16_t>("Red") == U16{9, 0, 7});
    CHECK(read.values<std::uint16_t>("Intensity") == U16{0, 4001, 4002});
    CHECK(read.values<double>("GPS Time") == std::vector<double>{1.5, 2.5, 0});
    CHECK(read.values<std::uint8_t>("isColorInvalid") == U8{0, 1, 0});
}

TEST_CASE("intensities of floats are stretched over their limits, and kept as stated beside") {
    std::vector<float> values{-0.5f, 0, 0.25f, 1};
    E57Points read = readWith({floatField("intensity", values)}, intensityLimits("-0.5", "1.0"));
    CHECK(read.values<std::uint16_t>("Intensity") == U16{0, 21845, 32768, 65535});
    CHECK(read.values<float>("intensity") == values);
    // No limits, or none that are a range: what was measured.
    for (const std::string& xml : {std::string(), intensityLimits("0", "0")}) {
        read = readWith({floatField("intensity", {2, 3, 4})}, xml);
        CHECK(read.values<std::uint16_t>("Intensity") == U16{0, 32768, 65535});
    }
    CHECK(readWith({floatField("intensity", {2, 2})}).values<std::uint16_t>("Intensity") == U16{0, 0});
}

TEST_CASE("intensities of scans with different limits are comparable") {
    E57Scan a = scanOf(1), b = scanOf(1);
    a.fields.push_back(floatField("intensity", {1}));
    a.xml = intensityLimits("0", "1");
    b.fields.push_back(floatField("intensity", {1}));
    b.xml = intensityLimits("0", "3");
    CHECK(readE57({{a, b}, ""}).values<std::uint16_t>("Intensity") == U16{21845, 21845});
}

TEST_CASE("returns count from 1, and are kept as stated where a byte may not hold them") {
    E57Points read = readWith(
        {integerField("returnIndex", 0, 7, {0, 1, 7}), integerField("returnCount", 1, 8, {1, 2, 8})});
    CHECK(read.values<std::uint8_t>("Return Number") == U8{1, 2, 8});
    CHECK(read.values<std::uint8_t>("Number of Returns") == U8{1, 2, 8});
    CHECK(read.description.schema.find("returnIndex") < 0);
    read = readWith({integerField("returnIndex", 0, 300, {0, 300})});
    CHECK(read.values<std::uint8_t>("Return Number") == U8{1, 255});
    CHECK(read.values<std::uint16_t>("returnIndex") == U16{0, 300});
}

TEST_CASE("times are adjusted standard GPS time where every scan says when it began") {
    std::string start =
        "<acquisitionStart><dateTimeValue type=\"Float\">1300000000.5</dateTimeValue></acquisitionStart>";
    E57Points read = readWith({floatField("timeStamp", {0, 0.25f})}, start);
    CHECK(read.values<double>("GPS Time") == std::vector<double>{300000000.5, 300000000.75});
    CHECK(read.description.gpsTime == GpsTimeKind::adjustedStandard);
    read = readWith({floatField("timeStamp", {0, 0.25f})});
    CHECK(read.values<double>("GPS Time") == std::vector<double>{0, 0.25});
    CHECK(read.description.gpsTime == GpsTimeKind::unknown);
    CHECK_THAT(read.description.warnings.at(0), Contains("count from the start of each scan"));
}

TEST_CASE("classes and fields of extensions keep their values, types and scales") {
    E57Points read = readWith({integerField("classification", 0, 31, {2, 6}),
                               scaledField("ext:amplitude", -100, 100, "0.01", "3", {-100, 50}),
                               floatField("nor:normalX", {0.5f, -1}), doubleField("ext:time", {1e-300, 2}),
                               integerField("rowIndex", 0, 70000, {0, 70000}),
                               integerField("columnIndex", -1, 10, {-1, 10})});
    CHECK(read.values<std::uint8_t>("Classification") == U8{2, 6});
    CHECK(read.attribute("ext:amplitude").scale == 0.01);
    CHECK(read.attribute("ext:amplitude").offset == 3);
    CHECK(read.values<std::int16_t>("ext:amplitude") == std::vector<std::int16_t>{-100, 50});
    CHECK(read.values<float>("nor:normalX") == std::vector<float>{0.5f, -1});
    CHECK(read.values<double>("ext:time") == std::vector<double>{1e-300, 2});
    CHECK(read.values<std::uint32_t>("rowIndex") == std::vector<std::uint32_t>{0, 70000});
    CHECK(read.values<std::int8_t>("columnIndex") == std::vector<std::int8_t>{-1, 10});
}

TEST_CASE("scans with different fields give the union, 0 standing for what one lacks") {
    E57Scan a = scanOf(1), b = scanOf(1), c = scanOf(1);
    a.fields.push_back(integerField("rowIndex", 0, 10, {5}));
    a.fields.push_back(floatField("ext:a", {1.5f}));
    b.fields.push_back(integerField("rowIndex", -300, 10, {-300}));
    b.fields.push_back(integerField("ext:a", 0, 9, {7}));
    c.xml = "<name type=\"String\">yard</name>";
    E57Points read = readE57({{a, b, c}, ""});
    CHECK(read.values<std::int16_t>("rowIndex") == std::vector<std::int16_t>{5, -300, 0});
    CHECK(read.values<double>("ext:a") == std::vector<double>{1.5, 7, 0});
    CHECK(read.values<std::uint16_t>("Point Source ID") == U16{1, 2, 3});
    CHECK(read.attribute("Point Source ID").description == "number of the scan: 3 yard");
    CHECK_THAT(read.description.warnings.at(0), Contains("rowIndex, ext:a"));
}

TEST_CASE("text is stepped over and said to be; structures in records are flattened") {
    E57Field text{"<label type=\"String\"/>", 8, {'a', 'b'}};
    E57Field nested = integerField("inner", 0, 3, {1, 2});
    nested.xml = cat("<ext:group type=\"Structure\">", nested.xml, "</ext:group>");
    E57Points read = readWith({text, nested});
    CHECK(read.values<std::uint8_t>("ext:group/inner") == U8{1, 2});
    CHECK(read.description.schema.find("label") < 0);
    CHECK_THAT(read.description.warnings.at(0), Contains("label"));
}

TEST_CASE("a field that has the name of a LAS attribute does not take its place") {
    E57Points read = readWith({integerField("Red", 0, 3, {1, 2}), integerField("colorRed", 0, 255, {8, 9})});
    CHECK(read.values<std::uint16_t>("Red") == U16{8, 9});
    CHECK(read.values<std::uint8_t>("Red (E57)") == U8{1, 2});
}

TEST_CASE("the CRS is that of coordinateMetadata, and a broken one is a warning") {
    E57Scan scan = scanOf(1);
    E57Points read =
        readE57({{scan}, "<coordinateMetadata type=\"String\"><![CDATA[EPSG:25832]]></coordinateMetadata>"});
    CHECK(read.description.crs.epsg == 25832);
    read = readE57({{scan}, "<coordinateMetadata type=\"String\">GEOGCS[oops</coordinateMetadata>"});
    CHECK(!read.description.crs.known());
    CHECK_THAT(read.description.warnings.at(0), Contains("coordinateMetadata"));
}

TEST_CASE("pictures and scans without points are left out, and said to be") {
    E57File file{{scanOf(2)}, "<images2D type=\"Vector\"><vectorChild/><vectorChild/></images2D>"};
    CHECK_THAT(readE57(file).description.warnings.at(0), Contains("2 pictures"));
}
