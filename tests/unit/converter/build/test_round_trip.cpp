#include "converter/build/compare.hpp"
#include "converter/build/input_parts.hpp"
#include "converter/build/verify.hpp"
#include "converter/export/export_file.hpp"
#include "shared/base/text.hpp"
#include "tests/unit/converter/build/test_scan.hpp"

#include <numeric>

using namespace stipple;
using namespace stipple::test;

namespace {
// All points as rows.
Bytes rowsOf(const Scan& scan, const RowLayout& layout) {
    Bytes rows;
    PartReader reader{{}, {}, PointSums(scan.inputs.size())};
    for (const PartRef& part : partsOf(scan)) {
        Status read = readPart(scan, part, reader, [&](const PointBatch& batch) -> Status {
            std::vector<std::uint32_t> all(batch.size());
            std::iota(all.begin(), all.end(), 0u);
            const std::size_t before = rows.size();
            rows.resize(before + batch.size() * layout.rowBytes());
            layout.pack(batch, all, rows.data() + before);
            return {};
        });
        REQUIRE(read.ok());
    }
    CHECK(reader.sums.maxGridError == 0);
    return rows;
}

// What verify --against does, for two LAS files.
Comparison compareLas(const std::string& a, const std::string& b) {
    auto scanA = scanInputs({a}, {}), scanB = scanInputs({b}, {});
    REQUIRE(scanA.ok());
    REQUIRE(scanB.ok());
    CHECK(mapOnto(*scanB, scanA->grid, scanA->schema).empty());
    RowLayout layout(scanA->schema, scanA->inputs[0].description().bounds);
    Bytes rowsA = rowsOf(*scanA, layout), rowsB = rowsOf(*scanB, layout);
    PointComparer comparer(layout, scanA->grid);
    comparer.addFile(rowsA.data(), rowsA.size() / layout.rowBytes());
    comparer.addInput(rowsB.data(), rowsB.size() / layout.rowBytes());
    return comparer.finish();
}

Attribute extra(const std::string& name, AttributeType type) {
    Attribute attribute;
    attribute.name = name;
    attribute.type = type;
    return attribute;
}
} // namespace

TEST_CASE("each point format goes through convert, verify and export with nothing changed", "[roundtrip]") {
    for (int format = 0; format <= 10; ++format) {
        INFO("point format " << format);
        TemporaryFolder folder;
        TestScan scan = surfaceScan(format, 5000, static_cast<std::uint64_t>(format));
        writeScan(scan, folder / "in.las");
        convertOrFail({folder / "in.las"}, folder / "c.stipple");
        auto report = verifyFile(folder / "c.stipple", {folder / "in.las"}, {.threads = 2}, noProgress);
        REQUIRE(report.ok());
        INFO((report->faults.empty() ? "" : report->faults[0]));
        CHECK(report->passed());
        REQUIRE(report->comparison);
        CHECK(report->comparison->equalPoints == 5000);

        auto exported = exportFile(folder / "c.stipple", folder / "out.las", {}, noProgress);
        REQUIRE(exported.ok());
        CHECK(exported->format.ends_with(cat(" ", format)));
        CHECK(exported->grid == scan.grid);
        Comparison comparison = compareLas(folder / "in.las", folder / "out.las");
        CHECK(comparison.same());
        CHECK(comparison.equalPoints == 5000);
    }
}

TEST_CASE("extra bytes of every type go through with their names and values", "[roundtrip]") {
    TemporaryFolder folder;
    TestScan scan;
    scan.pointFormat = 6;
    scan.schema = las::schemaOf(6);
    for (AttributeType type :
         {AttributeType::u8, AttributeType::i8, AttributeType::u16, AttributeType::i16, AttributeType::u32,
          AttributeType::i32, AttributeType::u64, AttributeType::i64, AttributeType::f32, AttributeType::f64})
        scan.schema.attributes.push_back(extra(std::string("extra ") + attributeTypeName(type), type));
    Attribute height = extra("height", AttributeType::i16);
    height.scale = 0.01;
    height.offset = 100;
    height.noData = -9999;
    height.description = "above ground";
    scan.schema.attributes.push_back(height);
    scan.points.resize(scan.schema, 2000);
    std::mt19937_64 random(5);
    for (Vec3i& p : scan.points.positions)
        p = {static_cast<std::int64_t>(random() % 1000), static_cast<std::int64_t>(random() % 1000), 0};
    fillAttributes(scan, random);
    writeScan(scan, folder / "in.las");
    ConvertResult result = convertOrFail({folder / "in.las"}, folder / "c.stipple");
    int found = result.metadata.schema.find("height");
    REQUIRE(found >= 0);
    CHECK(result.metadata.schema.attributes[static_cast<std::size_t>(found)] == height);
    REQUIRE(exportFile(folder / "c.stipple", folder / "out.las", {}, noProgress).ok());
    CHECK(compareLas(folder / "in.las", folder / "out.las").same());
}

TEST_CASE("integers beyond 32 bits are exported from another offset", "[roundtrip]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(0, 500, 1), b = surfaceScan(0, 500, 2);
    a.grid.offset = {0, 0, 0};
    for (Vec3i& p : a.points.positions)
        p.x += 2000000000;
    b.grid.offset = {0, 0, 0};
    b.grid.scale.x = 0.001; // the common grid counts a's x to 2 × 10^10
    for (Vec3i& p : b.points.positions)
        p.x = 2147000000 - p.x;
    for (Vec3i& p : a.points.positions)
        p.x -= 1700000000;
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    convertOrFail({folder / "a.las", folder / "b.las"}, folder / "c.stipple");
    auto exported = exportFile(folder / "c.stipple", folder / "out.las", {}, noProgress);
    REQUIRE(exported.ok());
    CHECK(exported->grid.offset.x != 0);
    CHECK(exported->grid.scale.x == 0.001);
    auto report = verifyFile(folder / "c.stipple", {folder / "out.las"}, {.threads = 1}, noProgress);
    REQUIRE(report.ok());
    CHECK(report->passed());
}

TEST_CASE("a cloud too wide for LAS is not exported, and leaves no file", "[roundtrip]") {
    TemporaryFolder folder;
    TestScan a = surfaceScan(0, 10, 1), b = a;
    b.grid.offset.x += 1e8; // 10^10 steps away
    writeScan(a, folder / "a.las");
    writeScan(b, folder / "b.las");
    convertOrFail({folder / "a.las", folder / "b.las"}, folder / "c.stipple");
    auto exported = exportFile(folder / "c.stipple", folder / "out.las", {}, noProgress);
    REQUIRE_FALSE(exported.ok());
    CHECK(exported.error().code == ErrorCode::outOfRange);
    CHECK(folder.files() == 3);
}
