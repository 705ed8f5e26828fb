// Extra bytes: described, half described, undescribed, and described wrongly.
#include "tests/unit/shared/las/las_bytes.hpp"

#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr std::size_t typeSizes[] = {0, 1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
enum Option : std::uint8_t { hasNoData = 1, hasMin = 2, hasMax = 4, hasScale = 8, hasOffset = 16 };

// A descriptor of 192 bytes by the layout of LAS 1.4 R15 table 24.
struct Described {
    std::uint8_t type = 1, options = 0;
    std::string name = "a", description{};
    std::array<std::uint64_t, 3> noData{};
    std::array<double, 3> scale{}, offset{};

    Bytes bytes() const {
        Bytes to(192);
        to[2] = type;
        to[3] = options;
        std::memcpy(to.data() + 4, name.data(), std::min<std::size_t>(32, name.size()));
        std::memcpy(to.data() + 40, noData.data(), 24);
        std::memcpy(to.data() + 112, scale.data(), 24);
        std::memcpy(to.data() + 136, offset.data(), 24);
        std::memcpy(to.data() + 160, description.data(), std::min<std::size_t>(32, description.size()));
        return to;
    }
};

las::Vlr recordOf(const std::vector<Described>& described) {
    las::Vlr vlr{"LASF_Spec", 4, "Extra Bytes Record", {}};
    for (const Described& one : described) {
        Bytes bytes = one.bytes();
        vlr.data.insert(vlr.data.end(), bytes.begin(), bytes.end());
    }
    return vlr;
}

LasRecipe recipeOf(const std::vector<Described>& described, std::size_t extraBytes) {
    LasRecipe recipe{4, 6, 10};
    recipe.extraBytes = extraBytes;
    recipe.vlrs = {recordOf(described)};
    return recipe;
}

// The attributes after those of the format.
std::vector<Attribute> extras(const LasContents& las) {
    auto first = las.schema.attributes.begin() +
                 static_cast<std::ptrdiff_t>(las::schemaOf(las.header.pointFormat).attributes.size());
    return {first, las.schema.attributes.end()};
}

std::vector<std::string> extraNames(const LasContents& las) {
    std::vector<std::string> names;
    for (const Attribute& attribute : extras(las))
        names.push_back(attribute.name);
    return names;
}

// Bytes [from, from + size) of the extra bytes of each record: what an attribute there must hold.
Bytes extraColumn(const LasRecipe& recipe, std::size_t from, std::size_t size) {
    Bytes records = randomRecords(recipe), column;
    std::size_t base = las::pointRecordSize(recipe.pointFormat), stride = base + recipe.extraBytes;
    for (std::size_t i = 0; i < recipe.points; ++i) {
        auto first = records.begin() + static_cast<std::ptrdiff_t>(i * stride + base + from);
        column.insert(column.end(), first, first + static_cast<std::ptrdiff_t>(size));
    }
    return column;
}

LasContents rewritten(const Bytes& bytes) {
    MemorySource source(bytes);
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    PointBatch points;
    REQUIRE((*reader)->read(0, (*reader)->pointCount(), points).ok());
    auto written = writeLas(las::optionsLike(**reader), points);
    if (!written.ok())
        FAIL(written.error().sentence());
    return requireLas(*written);
}

} // namespace

TEST_CASE("extra bytes of every type have their type, components and values, and survive a round trip") {
    for (std::uint8_t type = 1; type <= 30; ++type) {
        CAPTURE(type);
        std::size_t components = (type - 1u) / 10 + 1, base = (type - 1u) % 10 + 1;
        std::size_t size = components * typeSizes[base];
        LasRecipe recipe = recipeOf({{type, 0, "Value", "what it is"}}, size);
        Bytes bytes = lasBytes(recipe);
        LasContents las = requireLas(bytes);
        CHECK(las.warnings.empty());
        REQUIRE(extras(las).size() == 1);
        const Attribute attribute = extras(las)[0];
        CHECK(attribute.name == "Value");
        CHECK(attribute.description == "what it is");
        CHECK(attribute.type == static_cast<AttributeType>(base - 1));
        CHECK(attribute.components == static_cast<int>(components));
        CHECK(attribute.scale == 1);
        CHECK(attribute.offset == 0);
        CHECK(!attribute.noData);
        CHECK(las.points.columns.back() == extraColumn(recipe, 0, size));

        LasContents again = rewritten(bytes);
        CHECK(again.schema == las.schema);
        CHECK(again.points.columns == las.points.columns);
    }
}

TEST_CASE("scale, offset and no-data come in the kind of their type, and survive a round trip") {
    auto bits = [](double value) { return bitCast<std::uint64_t>(value); };
    auto negative = static_cast<std::uint64_t>(std::int64_t{-5});
    std::vector<Described> described{
        {1, hasNoData | hasScale | hasOffset, "u8", "", {255}, {0.5}, {-3}},
        {4, hasNoData | hasScale, "i16", "", {negative}, {-0.01}, {9}},
        {7, hasNoData, "u64", "", {~0ull}},
        {8, hasNoData, "i64", "", {1ull << 63}},
        {9, hasNoData, "f32", "", {bits(-9999)}},
        {10, hasOffset, "f64", "", {bits(-1)}, {7}, {1e6}},
    };
    LasContents las = requireLas(lasBytes(recipeOf(described, 31)));
    CHECK(las.warnings.empty());
    auto found = extras(las);
    REQUIRE(found.size() == 6);
    CHECK(found[0].noData == 255.0);
    CHECK(found[0].scale == 0.5);
    CHECK(found[0].offset == -3);
    CHECK(found[1].noData == -5.0);
    CHECK(found[1].scale == -0.01);
    CHECK(found[1].offset == 0); // there, but its bit is not set
    CHECK(found[2].noData == 0x1p64);
    CHECK(found[3].noData == -0x1p63);
    CHECK(found[4].noData == -9999.0);
    CHECK(!found[5].noData);
    CHECK(found[5].scale == 1);
    CHECK(found[5].offset == 1e6);
    LasContents again = rewritten(lasBytes(recipeOf(described, 31)));
    CHECK(again.schema == las.schema);
    // The largest u64 is written as such again, though a double rounds it up.
    Bytes record = again.header.vlrs.back().data;
    CHECK(loadLe<std::uint64_t>(record.data() + 2 * 192 + 40) == ~0ull);
    CHECK(loadLe<std::uint64_t>(record.data() + 3 * 192 + 40) == 1ull << 63);
}

TEST_CASE("a scale that makes no values is ignored with a warning") {
    for (double scale : {0.0, std::nan(""), HUGE_VAL}) {
        LasContents las = requireLas(lasBytes(recipeOf({{3, hasScale, "a", "", {}, {scale}}}, 2)));
        CHECK(extras(las)[0].scale == 1);
        CHECK(anyContains(las.warnings, "stored values"));
    }
}

TEST_CASE("a tuple whose components are scaled differently becomes one attribute for each") {
    LasRecipe recipe = recipeOf({{23, hasScale, "n", "normal", {}, {1, 2, 4}}}, 6);
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extraNames(las) == std::vector<std::string>{"n[0]", "n[1]", "n[2]"});
    CHECK(extras(las)[2].scale == 4);
    CHECK(las.points.columns.back() == extraColumn(recipe, 4, 2));
    LasContents again = rewritten(lasBytes(recipe));
    CHECK(again.schema == las.schema);
    CHECK(again.points.columns == las.points.columns);
}

TEST_CASE("undescribed bytes inside and after the described ones are kept") {
    // 3 bytes of type 0 (their number stands in the options), a float, and 5 bytes nobody describes.
    LasRecipe recipe = recipeOf({{0, 3, "Reserved"}, {9, 0, "f"}}, 12);
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(las.warnings.empty());
    auto found = extras(las);
    REQUIRE(found.size() == 3);
    CHECK(found[0].components == 3);
    CHECK(found[1].type == AttributeType::f32);
    CHECK(found[2].name == "Extra Bytes");
    CHECK(found[2].components == 5);
    CHECK(las.points.columns.back() == extraColumn(recipe, 7, 5));
    LasContents again = rewritten(lasBytes(recipe));
    CHECK(again.schema == las.schema);
    CHECK(again.points.columns == las.points.columns);
}

TEST_CASE("more undescribed bytes than an attribute has components come in parts") {
    LasRecipe recipe{4, 6, 3};
    recipe.extraBytes = 600;
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extraNames(las) == std::vector<std::string>{"Extra Bytes", "Extra Bytes 2", "Extra Bytes 3"});
    CHECK(extras(las)[2].components == 90);
}

TEST_CASE("names that are empty, doubled or taken by LAS are made unique") {
    LasRecipe recipe = recipeOf(
        {{1, 0, ""}, {1, 0, ""}, {1, 0, "Intensity"}, {1, 0, "a"}, {1, 0, "a 2"}, {1, 0, "a"}, {1, 0, "a"}},
        7);
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extraNames(las) ==
          std::vector<std::string>{"Unnamed", "Unnamed 2", "Intensity 2", "a", "a 2", "a 3", "a 4"});
    CHECK(rewritten(lasBytes(recipe)).schema == las.schema);
}

TEST_CASE("thousands of equal names take no time") {
    LasRecipe recipe{4, 6, 1};
    recipe.extraBytes = 60000;
    las::Vlr vlr = recordOf(std::vector<Described>(60000, Described{1, 0, "same"}));
    vlr.extended = true;
    recipe.vlrs = {vlr};
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extras(las).size() == 60000);
    CHECK(las.schema.attributes.back().name == "same 60000");
}

TEST_CASE("descriptors that cover more than the record has are ignored from there on") {
    LasRecipe recipe = recipeOf({{3, 0, "a"}, {10, 0, "too long"}, {1, 0, "after"}}, 6);
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extraNames(las) == std::vector<std::string>{"a", "Extra Bytes"});
    CHECK(extras(las)[1].components == 4);
    CHECK(anyContains(las.warnings, "\"too long\" need 8 bytes, but the point record has only 4 left"));
}

TEST_CASE("an unknown type leaves what follows undescribed") {
    for (std::uint8_t type : {std::uint8_t{31}, std::uint8_t{255}}) {
        LasContents las = requireLas(lasBytes(recipeOf({{3, 0, "a"}, {type, 0, "new"}, {1, 0, "b"}}, 6)));
        CHECK(extraNames(las) == std::vector<std::string>{"a", "Extra Bytes"});
        CHECK(anyContains(las.warnings, "unknown type"));
    }
}

TEST_CASE("a record of descriptors that is cut off counts as far as it goes") {
    LasRecipe recipe = recipeOf({{3, 0, "a"}, {3, 0, "b"}}, 4);
    recipe.vlrs[0].data.resize(300);
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(extraNames(las) == std::vector<std::string>{"a", "Extra Bytes"});
    CHECK(anyContains(las.warnings, "not a multiple of 192"));
}

TEST_CASE("descriptors spread over several records count together") {
    LasRecipe recipe = recipeOf({{3, 0, "a"}}, 4);
    recipe.vlrs.push_back(recordOf({{3, 0, "b"}}));
    CHECK(extraNames(requireLas(lasBytes(recipe))) == std::vector<std::string>{"a", "b"});
    recipe.vlrs[1].extended = true;
    CHECK(extraNames(requireLas(lasBytes(recipe))) == std::vector<std::string>{"a", "b"});
}

TEST_CASE("written descriptors state the smallest and largest value that is not no-data") {
    las::WriterOptions options;
    Attribute depth{"depth", AttributeType::i16, 1, "below", "", 0.1, 0, -1.0};
    Attribute pair{"pair", AttributeType::f32, 2};
    options.schema.attributes = {depth, pair};
    PointBatch points;
    points.resize(options.schema, 3);
    std::int16_t depths[] = {-1, 300, -200};
    float pairs[] = {1, 2, std::nanf(""), -7, 0.5f, 5};
    std::memcpy(points.columns[0].data(), depths, sizeof depths);
    std::memcpy(points.columns[1].data(), pairs, sizeof pairs);
    auto bytes = writeLas(options, points);
    REQUIRE(bytes.ok());
    LasContents las = requireLas(*bytes);
    CHECK(las.header.versionMinor == 4);
    CHECK(las.schema.attributes[las.schema.attributes.size() - 2] == depth);
    const Bytes& record = las.header.vlrs[0].data;
    REQUIRE(record.size() == 384);
    CHECK(record[2] == 4);
    CHECK(record[3] == (hasNoData | hasMin | hasMax | hasScale));
    CHECK(loadLe<std::int64_t>(record.data() + 64) == -200);
    CHECK(loadLe<std::int64_t>(record.data() + 88) == 300);
    const std::uint8_t* second = record.data() + 192;
    CHECK(second[2] == 19);
    CHECK(loadLe<double>(second + 64) == 0.5);
    CHECK(loadLe<double>(second + 72) == -7);
    CHECK(loadLe<double>(second + 88) == 1);
    CHECK(loadLe<double>(second + 96) == 5);
}
