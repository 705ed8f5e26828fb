// Every attribute of every point format in each kind of file.
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "tests/unit/converter/export/export_fixture.hpp"

#include <cmath>

using namespace stipple;
using namespace stipple::test;

namespace {

// A stored value as text, the way the test understands it.
template <class T>
T storedAt(const AllPoints& all, std::size_t a, std::size_t i, int component = 0) {
    const Attribute& attribute = all.metadata.schema.attributes[a];
    T value;
    std::memcpy(&value,
                all.points.columns[a].data() + i * attribute.size() +
                    static_cast<std::size_t>(component) * sizeof(T),
                sizeof value);
    return value;
}

// Is `text` exactly the stored value?
bool saysValue(const std::string& text, const AllPoints& all, std::size_t a, std::size_t i, int c) {
    switch (all.metadata.schema.attributes[a].type) {
    case AttributeType::u8:
        return text == std::to_string(storedAt<std::uint8_t>(all, a, i, c));
    case AttributeType::i8:
        return text == std::to_string(storedAt<std::int8_t>(all, a, i, c));
    case AttributeType::u16:
        return text == std::to_string(storedAt<std::uint16_t>(all, a, i, c));
    case AttributeType::i16:
        return text == std::to_string(storedAt<std::int16_t>(all, a, i, c));
    case AttributeType::u32:
        return text == std::to_string(storedAt<std::uint32_t>(all, a, i, c));
    case AttributeType::i32:
        return text == std::to_string(storedAt<std::int32_t>(all, a, i, c));
    case AttributeType::u64:
        return text == std::to_string(storedAt<std::uint64_t>(all, a, i, c));
    case AttributeType::i64:
        return text == std::to_string(storedAt<std::int64_t>(all, a, i, c));
    case AttributeType::f32:
        return std::stof(text) == storedAt<float>(all, a, i, c);
    case AttributeType::f64:
        return std::stod(text) == storedAt<double>(all, a, i, c);
    }
    return false;
}

void checkCsv(const AllPoints& all, const CsvContent& csv) {
    REQUIRE(csv.rows.size() == all.points.size());
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        // Two places, offsets 500000 and 4000000: testScan's grid.
        REQUIRE(decimalDigits(csv.rows[i][0], 2) == all.points.positions[i].x + 50000000);
        REQUIRE(decimalDigits(csv.rows[i][1], 2) == all.points.positions[i].y + 400000000);
        REQUIRE(decimalDigits(csv.rows[i][2], 2) == all.points.positions[i].z);
    }
    std::size_t at = 3;
    for (std::size_t a = 0; a < all.metadata.schema.attributes.size(); ++a) {
        const Attribute& attribute = all.metadata.schema.attributes[a];
        for (int c = 0; c < attribute.components; ++c, ++at) {
            INFO(attribute.name);
            REQUIRE(at < csv.names.size());
            CHECK(csv.names[at] ==
                  (attribute.components == 1 ? attribute.name : cat(attribute.name, "[", c, "]")));
            for (std::size_t i = 0; i < csv.rows.size(); ++i) {
                INFO(csv.rows[i][at]);
                if (attribute.name == "Scan Angle") // thousandths of six thousandths of a degree
                    REQUIRE(decimalDigits(csv.rows[i][at], 3) == 6 * storedAt<std::int16_t>(all, a, i));
                else if (attribute.scale == 1)
                    REQUIRE(saysValue(csv.rows[i][at], all, a, i, c));
            }
        }
    }
    CHECK(at == csv.names.size());
}

double plainNumber(const AllPoints& all, std::size_t a, std::size_t i, int c) {
    switch (all.metadata.schema.attributes[a].type) {
    case AttributeType::u8:
        return storedAt<std::uint8_t>(all, a, i, c);
    case AttributeType::i8:
        return storedAt<std::int8_t>(all, a, i, c);
    case AttributeType::u16:
        return storedAt<std::uint16_t>(all, a, i, c);
    case AttributeType::i16:
        return storedAt<std::int16_t>(all, a, i, c);
    case AttributeType::u32:
        return storedAt<std::uint32_t>(all, a, i, c);
    case AttributeType::i32:
        return storedAt<std::int32_t>(all, a, i, c);
    case AttributeType::f32:
        return storedAt<float>(all, a, i, c);
    case AttributeType::f64:
        return storedAt<double>(all, a, i, c);
    default:
        FAIL("64-bit integers are looked at apart");
        return 0;
    }
}

std::string plyName(std::string name) {
    for (char& c : name)
        c = c == ' ' || c == '-' ? '_' : static_cast<char>(std::tolower(c));
    return name;
}

void checkPly(const AllPoints& all, const PlyContent& ply) {
    REQUIRE(ply.count == all.points.size());
    for (std::size_t i = 0; i < ply.count; ++i) {
        Vec3d world = all.world(i);
        REQUIRE(ply.values.at("x")[i] == world.x);
        REQUIRE(ply.values.at("y")[i] == world.y);
        REQUIRE(ply.values.at("z")[i] == world.z);
    }
    for (std::size_t a = 0; a < all.metadata.schema.attributes.size(); ++a) {
        const Attribute& attribute = all.metadata.schema.attributes[a];
        std::string name = plyName(attribute.name);
        INFO(name);
        if (attribute.type == AttributeType::u64) {
            for (std::size_t i = 0; i < ply.count; ++i) {
                auto stored = storedAt<std::uint64_t>(all, a, i);
                REQUIRE(ply.values.at(name + "_low")[i] == static_cast<double>(stored & 0xFFFFFFFF));
                REQUIRE(ply.values.at(name + "_high")[i] == static_cast<double>(stored >> 32));
            }
            continue;
        }
        REQUIRE(ply.values.count(name) == 1);
        for (std::size_t i = 0; i < ply.count; ++i)
            REQUIRE(ply.values.at(name)[i] == attribute.offset + attribute.scale * plainNumber(all, a, i, 0));
    }
}

Attribute extra(const std::string& name, AttributeType type, int components = 1) {
    Attribute attribute;
    attribute.name = name;
    attribute.type = type;
    attribute.components = components;
    return attribute;
}

// The converter says in the description of GPS Time what it counts from; LAS has a bit of the header for
// that.
void checkSchema(const Schema& found, Schema expected) {
    if (int time = expected.find("GPS Time"); time >= 0)
        expected.attributes[static_cast<std::size_t>(time)].description = {};
    CHECK(found == expected);
}

// One column of a cloud with extra bytes filled by `fill`.
struct ExtraScan {
    TemporaryFolder folder;
    std::string cloud = folder / "c.stipple";

    explicit ExtraScan(std::vector<Attribute> extras, int count = 300) {
        TestScan scan = surfaceScan(6, 0, 7);
        for (Attribute& attribute : extras)
            scan.schema.attributes.push_back(std::move(attribute));
        scan.points.resize(scan.schema, static_cast<std::size_t>(count));
        std::mt19937_64 random(5);
        for (Vec3i& p : scan.points.positions)
            p = {static_cast<std::int64_t>(random() % 1000), static_cast<std::int64_t>(random() % 1000), 0};
        fillAttributes(scan, random);
        writeScan(scan, folder / "in.las");
        convertOrFail({folder / "in.las"}, cloud);
    }
};

} // namespace

TEST_CASE("each point format is exported as LAS, LAZ, PLY and CSV with every attribute of every point") {
    for (int format = 0; format <= 10; ++format) {
        INFO("point format " << format);
        TemporaryFolder folder;
        writeScan(surfaceScan(format, 700, static_cast<std::uint64_t>(format)), folder / "in.las");
        convertOrFail({folder / "in.las"}, folder / "c.stipple");
        AllPoints all = allPoints(folder / "c.stipple");
        ExportResult result = exportOrFail(folder / "c.stipple", folder / "out.las");
        CHECK(result.points == 700);
        CHECK(result.warnings.empty());
        CHECK(result.bytes == std::filesystem::file_size(folder / "out.las"));
        LasContent las = readLas(folder / "out.las");
        CHECK(las.header.pointFormat == format);
        CHECK(las.header.grid == all.metadata.grid);
        checkSchema(las.schema, all.metadata.schema);
        requireEqual(las.points, all.points);
        ExportResult packed = exportOrFail(folder / "c.stipple", folder / "out.laz");
        CHECK(packed.format.starts_with("LAZ 1."));
        LasContent laz = readLas(folder / "out.laz");
        CHECK(laz.header.compressed);
        CHECK(laz.header.pointFormat == format);
        checkSchema(laz.schema, all.metadata.schema);
        requireEqual(laz.points, all.points);
        exportOrFail(folder / "c.stipple", folder / "out.csv");
        checkCsv(all, readCsv(textOf(folder / "out.csv")));
        exportOrFail(folder / "c.stipple", folder / "out.ply");
        checkPly(all, readPly(textOf(folder / "out.ply")));
    }
}

TEST_CASE("extra bytes of every type are in LAS, LAZ, PLY and CSV") {
    std::vector<Attribute> extras;
    for (AttributeType type :
         {AttributeType::u8, AttributeType::i8, AttributeType::u16, AttributeType::i16, AttributeType::u32,
          AttributeType::i32, AttributeType::u64, AttributeType::i64, AttributeType::f32, AttributeType::f64})
        extras.push_back(extra(std::string("e") + attributeTypeName(type), type));
    ExtraScan scan(extras);
    AllPoints all = allPoints(scan.cloud);
    exportOrFail(scan.cloud, scan.folder / "out.las");
    LasContent las = readLas(scan.folder / "out.las");
    checkSchema(las.schema, all.metadata.schema);
    requireEqual(las.points, all.points);
    exportOrFail(scan.cloud, scan.folder / "out.laz");
    LasContent laz = readLas(scan.folder / "out.laz");
    checkSchema(laz.schema, all.metadata.schema);
    requireEqual(laz.points, all.points);
    exportOrFail(scan.cloud, scan.folder / "out.csv");
    checkCsv(all, readCsv(textOf(scan.folder / "out.csv")));
    exportOrFail(scan.cloud, scan.folder / "out.ply");
    PlyContent ply = readPly(textOf(scan.folder / "out.ply"));
    auto wide = static_cast<std::size_t>(all.metadata.schema.find("eint64"));
    for (std::size_t i = 0; i < ply.count; ++i) { // signed halves
        double value = ply.values.at("eint64_high")[i] * 0x1p32;
        REQUIRE(static_cast<std::int64_t>(value) +
                    static_cast<std::int64_t>(ply.values.at("eint64_low")[i]) ==
                storedAt<std::int64_t>(all, wide, i));
    }
    all.metadata.schema.attributes.erase(all.metadata.schema.attributes.begin() +
                                         static_cast<std::ptrdiff_t>(wide));
    all.points.columns.erase(all.points.columns.begin() + static_cast<std::ptrdiff_t>(wide));
    checkPly(all, ply);
}

TEST_CASE("scaled attributes are written as the values they mean, no value as nothing") {
    Attribute height = extra("Height, \"above\" ground", AttributeType::i16);
    height.scale = 0.01;
    height.offset = 100;
    height.noData = -9999;
    Attribute three = extra("three", AttributeType::u8, 3);
    ExtraScan scan({height, three}, 70000); // so many that -9999 is among them
    AllPoints all = allPoints(scan.cloud);
    auto column = static_cast<std::size_t>(all.metadata.schema.find(height.name));
    exportOrFail(scan.cloud, scan.folder / "out.csv");
    CsvContent csv = readCsv(textOf(scan.folder / "out.csv"));
    exportOrFail(scan.cloud, scan.folder / "out.ply");
    PlyContent ply = readPly(textOf(scan.folder / "out.ply"));
    auto place = static_cast<std::size_t>(std::find(csv.names.begin(), csv.names.end(), height.name) -
                                          csv.names.begin());
    REQUIRE(place < csv.names.size());
    const std::vector<double>& values = ply.values.at("Height,_\"above\"_ground");
    std::size_t nothing = 0;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
        int stored = storedAt<std::int16_t>(all, column, i);
        if (stored == -9999) {
            ++nothing;
            REQUIRE(csv.rows[i][place].empty());
            REQUIRE(std::isnan(values[i]));
            continue;
        }
        REQUIRE(decimalDigits(csv.rows[i][place], 2) == 10000 + stored);
        REQUIRE(values[i] == 100 + 0.01 * stored);
    }
    CHECK(nothing > 0);
    CHECK(std::count(csv.names.begin(), csv.names.end(), "three[2]") == 1);
    CHECK(ply.values.count("three_2") == 1);
    std::string comments;
    for (const std::string& comment : ply.comments)
        comments += comment + "\n";
    CHECK(comments.find("is 100 + 0.01 * the stored int16; nan is no value") != std::string::npos);
}

TEST_CASE("8-bit colours are uchar in PLY, others ushort") {
    for (int limit : {256, 65536}) {
        TemporaryFolder folder;
        TestScan scan = surfaceScan(2, 500, 1);
        for (const char* name : {"Red", "Green", "Blue"})
            for (std::size_t i = 0; i < 500; ++i)
                scan.points.setValue<std::uint16_t>(
                    scan.schema.find(name), i,
                    static_cast<std::uint16_t>(i * 131 % static_cast<std::size_t>(limit)));
        writeScan(scan, folder / "in.las");
        convertOrFail({folder / "in.las"}, folder / "c.stipple");
        exportOrFail(folder / "c.stipple", folder / "out.ply");
        AllPoints all = allPoints(folder / "c.stipple");
        PlyContent ply = readPly(textOf(folder / "out.ply"));
        checkPly(all, ply);
        for (std::size_t p = 0; p < ply.names.size(); ++p)
            if (ply.names[p] == "green")
                CHECK(ply.types[p] == (limit == 256 ? "uchar" : "ushort"));
    }
}

TEST_CASE("attributes named as fields of LAS but of other types go to its extra bytes") {
    // Made in memory, for no LAS file has them.
    SmallCloudFile file;
    auto source = need(openFileSource(file.path));
    auto reader = need(CloudReader::open(*source));
    CloudMetadata metadata = reader->metadata();
    REQUIRE(metadata.schema.find("Point Source ID") == 1);
    metadata.schema.attributes[1].name = "User Data"; // two bytes instead of one
    auto writer = need(CloudWriter::create(file.folder / "odd.stipple"));
    Status copied = reader->visitNodes([&](const NodeEntry& entry) -> Status {
        return writer->add(need(encodeNode(metadata, entry.key, need(reader->readNode(entry)))));
    });
    REQUIRE(copied.ok());
    need(writer->finish(metadata));
    ExportResult result = exportOrFail(file.folder / "odd.stipple", file.folder / "out.las");
    REQUIRE(result.warnings.size() == 1);
    CHECK(result.warnings[0] == "LAS stores \"User Data\" as one uint8; it went to the extra bytes as "
                                "\"User Data (uint16)\"");
    AllPoints all = allPoints(file.folder / "odd.stipple");
    LasContent las = readLas(file.folder / "out.las");
    int column = las.schema.find("User Data (uint16)");
    REQUIRE(column >= 0);
    CHECK((las.points.columns[static_cast<std::size_t>(column)] == all.points.columns[1]));
}

TEST_CASE("a part of the attributes takes the smallest point format that holds their values") {
    TemporaryFolder folder;
    TestScan scan = surfaceScan(7, 500, 3);
    writeScan(scan, folder / "in.las");
    convertOrFail({folder / "in.las"}, folder / "c.stipple");
    auto formatFor = [&](const char* attributes) {
        ExportOptions options;
        options.attributes = {{attributes}};
        exportOrFail(folder / "c.stipple", folder / "out.las", options);
        return readLas(folder / "out.las").header.pointFormat;
    };
    CHECK(formatFor("Intensity") == 0);
    CHECK(formatFor("Intensity,GPS Time") == 1);
    CHECK(formatFor("Intensity,Red,Green,Blue") == 2);
    CHECK(formatFor("Classification") == 6); // its values need eight bits
    CHECK(formatFor("") == 0);
}

TEST_CASE("the CRS is in LAS and PLY") {
    TemporaryFolder folder;
    writeScan(surfaceScan(1, 100, 3), folder / "in.las");
    ConvertOptions options;
    options.crs = "EPSG:26910";
    ConvertResult converted = convertOrFail({folder / "in.las"}, folder / "c.stipple", options);
    exportOrFail(folder / "c.stipple", folder / "out.las");
    CHECK(las::wktRecord(readLas(folder / "out.las").header) == converted.metadata.crs.wkt);
    exportOrFail(folder / "c.stipple", folder / "out.ply");
    PlyContent ply = readPly(textOf(folder / "out.ply"));
    CHECK(std::count(ply.comments.begin(), ply.comments.end(), "comment crs EPSG:26910") == 1);
    CHECK(std::count_if(ply.comments.begin(), ply.comments.end(), [](const std::string& comment) {
              return comment.find("comment crs PROJCS[\"NAD83 / UTM zone 10N\"") == 0;
          }) == 1);
}
