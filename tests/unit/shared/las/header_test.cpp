// Headers as they are found: standard ones, long ones, old ones, and those that contradict themselves.
#include "tests/unit/shared/las/las_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

template <class T>
void put(Bytes& bytes, std::size_t at, T value) {
    storeLe(bytes.data() + at, value);
}

Error requireError(Bytes bytes) {
    auto contents = readLas(std::move(bytes));
    REQUIRE(!contents.ok());
    CHECK(contents.error().where.find("test.las") == 0);
    return contents.error();
}

las::Vlr record(std::string user, std::uint16_t id, std::size_t size, bool extended = false) {
    las::Vlr vlr{std::move(user), id, "a description", Bytes(size), extended};
    for (std::size_t i = 0; i < size; ++i)
        vlr.data[i] = static_cast<std::uint8_t>(i * 7 + id);
    return vlr;
}

} // namespace

TEST_CASE("a header is read field by field") {
    LasContents las = requireLas(lasBytes({2, 1, 3}));
    CHECK(las.header.versionMinor == 2);
    CHECK(las.header.pointFormat == 1);
    CHECK(las.header.systemIdentifier == "test system");
    CHECK(las.header.generatingSoftware == "las_bytes");
    CHECK(las.header.creationDay == 123);
    CHECK(las.header.creationYear == 2024);
    CHECK(las.header.grid.scale == Vec3d{0.01, 0.01, 0.01});
    CHECK(las.header.grid.offset == Vec3d{1000, 2000, 3000});
    CHECK(las.header.pointCount == 3);
    CHECK(las.warnings.empty());
}

TEST_CASE("a file that is no LAS file is refused in one sentence") {
    CHECK(requireError({}).code == ErrorCode::corrupt);
    CHECK(requireError(Bytes(1000, 'x')).code == ErrorCode::corrupt);
    Bytes short_ = lasBytes({});
    short_.resize(100);
    Error error = requireError(short_);
    CHECK(error.code == ErrorCode::truncated);
    CHECK(error.what == "the header ends after 100 of 227 bytes");
}

TEST_CASE("versions and point formats nobody knows are refused") {
    Bytes bytes = lasBytes({});
    put(bytes, atVersionMinor, std::uint8_t{5});
    CHECK(requireError(bytes).code == ErrorCode::unsupported);
    bytes = lasBytes({});
    put(bytes, 24, std::uint8_t{2});
    CHECK(requireError(bytes).code == ErrorCode::unsupported);
    bytes = lasBytes({});
    put(bytes, atPointFormat, std::uint8_t{11});
    CHECK(requireError(bytes).code == ErrorCode::unsupported);
}

TEST_CASE("a record length too short for its format is refused") {
    Bytes bytes = lasBytes({2, 3, 1});
    put(bytes, atRecordLength, std::uint16_t{33});
    CHECK(requireError(bytes).what ==
          "point records of format 3 need 34 bytes, but the header gives them 33");
}

TEST_CASE("a scale that is no positive number is refused") {
    for (double scale : {0.0, -0.01, std::nan(""), HUGE_VAL}) {
        Bytes bytes = lasBytes({});
        put(bytes, atScale + 8, scale);
        Error error = requireError(bytes);
        CHECK(error.code == ErrorCode::corrupt);
        CHECK(error.where == "test.las, byte 139");
    }
    Bytes bytes = lasBytes({});
    put(bytes, 155, std::nan(""));
    CHECK(requireError(bytes).code == ErrorCode::corrupt);
}

TEST_CASE("a header longer than its version needs is skipped to its end") {
    Bytes bytes = lasBytes({2, 0, 5});
    LasContents plain = requireLas(bytes);
    bytes.insert(bytes.begin() + 227, 40, 0xEE);
    put(bytes, atHeaderSize, std::uint16_t{267});
    put(bytes, atPointDataOffset, std::uint32_t{267});
    LasContents las = requireLas(bytes);
    CHECK(las.warnings.empty());
    CHECK(las.points.positions == plain.points.positions);
}

TEST_CASE("a 1.4 header that is too short for its counts falls back on the legacy count") {
    Bytes bytes = lasBytes({2, 0, 5});
    put(bytes, atVersionMinor, std::uint8_t{4});
    LasContents las = requireLas(bytes);
    CHECK(las.points.size() == 5);
    CHECK(anyContains(las.warnings, "too short for LAS 1.4"));
}

TEST_CASE("the 64-bit count holds where the two counts disagree") {
    Bytes bytes = lasBytes({4, 1, 5});
    put(bytes, atLegacyCount, std::uint32_t{4});
    LasContents las = requireLas(bytes);
    CHECK(las.points.size() == 5);
    CHECK(anyContains(las.warnings, "the legacy point count is 4; the 64-bit count of 5 holds"));
    put(bytes, atLegacyCount, std::uint32_t{0});
    CHECK(requireLas(bytes).warnings.empty());
}

TEST_CASE("the legacy count holds where the 64-bit count was left at 0") {
    Bytes bytes = lasBytes({4, 1, 5});
    put(bytes, atCount, std::uint64_t{0});
    LasContents las = requireLas(bytes);
    CHECK(las.points.size() == 5);
    CHECK(anyContains(las.warnings, "the legacy count 5 holds"));
}

TEST_CASE("a count beyond the end of the file gives the points that are there") {
    Bytes bytes = lasBytes({4, 6, 5});
    for (std::uint64_t count : {6ull, 1ull << 32, ~0ull}) {
        put(bytes, atCount, count);
        LasContents las = requireLas(bytes);
        CHECK(las.points.size() == 5);
        CHECK(las.header.pointCount == count);
        CHECK(anyContains(las.warnings, "the file ends after 5"));
    }
    bytes.resize(bytes.size() - 1);
    CHECK(requireLas(bytes).points.size() == 4);
}

TEST_CASE("a count that runs into the extended records gives the points before them") {
    LasRecipe recipe{4, 6, 5};
    recipe.vlrs = {record("one", 1, 500, true)};
    Bytes bytes = lasBytes(recipe);
    put(bytes, atCount, std::uint64_t{7});
    LasContents las = requireLas(bytes);
    CHECK(las.points.size() == 5);
    CHECK(las.header.vlrs.size() == 1);
    CHECK(anyContains(las.warnings, "the extended records begin after 5"));
    // Records that do not end with the file are not believed so far.
    bytes.push_back(0);
    CHECK(requireLas(bytes).points.size() == 7);
}

TEST_CASE("a point format from a later version is read, with a warning") {
    LasContents las = requireLas(lasBytes({2, 7, 5}));
    CHECK(anyContains(las.warnings, "point format 7 is not part of LAS 1.2"));
    CHECK(las.schema == las::schemaOf(7));
}

TEST_CASE("the signature of LAS 1.0 before the points is no point") {
    LasRecipe recipe{0, 1, 5};
    recipe.vlrs = {record("someone", 5, 30)};
    Bytes records = randomRecords(recipe);
    LasContents plain = requireLas(lasBytes(recipe, records));
    CHECK(plain.warnings.empty());
    for (Bytes signature : {Bytes{0xDD, 0xCC}, Bytes{0xCC, 0xDD}}) {
        recipe.beforePoints = signature;
        Bytes bytes = lasBytes(recipe, records);
        // As the specification has it: the offset is past the signature.
        LasContents las = requireLas(bytes);
        CHECK(las.warnings.empty());
        CHECK(las.points.positions == plain.points.positions);
        // As some writers had it: the offset is that of the signature.
        put(bytes, atPointDataOffset, static_cast<std::uint32_t>(227 + 54 + 30));
        las = requireLas(bytes);
        CHECK(las.points.positions == plain.points.positions);
        CHECK(las.header.pointDataOffset == 227 + 54 + 30 + 2);
        CHECK(anyContains(las.warnings, "signature"));
    }
}

TEST_CASE("a first X that looks like the signature of LAS 1.0 stays a point") {
    LasRecipe recipe{0, 0, 2};
    Bytes records = randomRecords(recipe);
    records[0] = 0xDD;
    records[1] = 0xCC;
    LasContents las = requireLas(lasBytes(recipe, records));
    CHECK(las.points.size() == 2);
    CHECK(las.points.positions[0].x == loadLe<std::int32_t>(records.data()));
}

TEST_CASE("a point data offset inside the header is corrected if the points follow the records") {
    LasRecipe recipe{1, 1, 5};
    recipe.vlrs = {record("someone", 5, 30)};
    Bytes bytes = lasBytes(recipe);
    LasContents plain = requireLas(bytes);
    for (std::uint32_t offset : {0u, 226u}) {
        put(bytes, atPointDataOffset, offset);
        LasContents las = requireLas(bytes);
        CHECK(las.points.positions == plain.points.positions);
        CHECK(las.header.vlrs.size() == 1);
        CHECK(anyContains(las.warnings, "lies inside the header"));
    }
    put(bytes, atLegacyCount, std::uint32_t{6});
    CHECK(requireError(bytes).code == ErrorCode::corrupt);
}

TEST_CASE("a file that ends before its points is truncated, unless it has none") {
    Bytes bytes = lasBytes({2, 1, 5});
    bytes.resize(227);
    CHECK(requireError(bytes).code == ErrorCode::truncated);
    bytes = lasBytes({2, 1, 0});
    LasContents las = requireLas(bytes);
    CHECK(las.points.size() == 0);
    CHECK(las.warnings.empty());
}

TEST_CASE("records come with their ids, texts and bytes, extended ones after the others") {
    LasRecipe recipe{4, 6, 5};
    recipe.vlrs = {record("LASF_Projection", 2112, 100), record("sixteen chars ok", 65535, 0),
                   record("big", 7, 100000, true), record("small", 8, 3, true)};
    LasContents las = requireLas(lasBytes(recipe));
    CHECK(las.warnings.empty());
    REQUIRE(las.header.vlrs.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(las.header.vlrs[i].userId == recipe.vlrs[i].userId);
        CHECK(las.header.vlrs[i].recordId == recipe.vlrs[i].recordId);
        CHECK(las.header.vlrs[i].description == "a description");
        CHECK(las.header.vlrs[i].data == recipe.vlrs[i].data);
        CHECK(las.header.vlrs[i].extended == recipe.vlrs[i].extended);
        CHECK(!las.header.vlrs[i].omitted);
    }
    CHECK(las.header.vlrs[0].offsetBytes == 375 + 54);
}

TEST_CASE("a count of records that runs into the points is cut with a warning") {
    LasRecipe recipe{2, 1, 5};
    recipe.vlrs = {record("someone", 5, 30)};
    Bytes bytes = lasBytes(recipe);
    for (std::uint32_t count : {2u, 0xFFFFFFFFu}) {
        put(bytes, atVlrCount, count);
        LasContents las = requireLas(bytes);
        CHECK(las.header.vlrs.size() == 1);
        CHECK(las.points.size() == 5);
        CHECK(anyContains(las.warnings, "only 1 lie before the points"));
    }
    put(bytes, atVlrCount, std::uint32_t{1});
    put(bytes, 227 + 20, std::uint16_t{31}); // its size: one byte more than there is
    LasContents las = requireLas(bytes);
    CHECK(las.header.vlrs.empty());
    CHECK(las.points.size() == 5);
    CHECK(anyContains(las.warnings, "claims 31 bytes, but the points begin before"));
}

TEST_CASE("extended records that claim more than the file has are cut with a warning") {
    LasRecipe recipe{4, 6, 5};
    recipe.vlrs = {record("one", 1, 10, true), record("two", 2, 10, true)};
    Bytes bytes = lasBytes(recipe);
    std::size_t second = bytes.size() - 70;
    for (std::uint64_t size : {11ull, 1ull << 40, ~0ull}) {
        Bytes broken = bytes;
        put(broken, second + 20, size);
        LasContents las = requireLas(broken);
        CHECK(las.header.vlrs.size() == 1);
        CHECK(las.points.size() == 5);
        CHECK(anyContains(las.warnings, "extended variable length record 2 of 2"));
    }
    for (std::uint64_t offset :
         {std::uint64_t{bytes.size()} + 1, std::uint64_t{1} << 50, ~std::uint64_t{0}}) {
        Bytes broken = bytes;
        put(broken, atEvlrOffset, offset);
        LasContents las = requireLas(broken);
        CHECK(las.header.vlrs.empty());
        CHECK(las.warnings.size() == 1);
    }
}

TEST_CASE("the waveform packets of LAS 1.3 are found, and left in the file") {
    LasRecipe recipe{3, 4, 5};
    Bytes bytes = lasBytes(recipe);
    std::uint64_t at = bytes.size();
    appendVlr(bytes, record("LASF_Spec", 65535, 1000, true));
    put(bytes, atWaveform, at);
    put(bytes, atGlobalEncoding, std::uint16_t{2}); // packets are in this file
    LasContents las = requireLas(bytes);
    CHECK(las.warnings.empty());
    REQUIRE(las.header.vlrs.size() == 1);
    CHECK(las.header.vlrs[0].omitted);
    CHECK(las.header.vlrs[0].data.empty());
    CHECK(las.header.vlrs[0].sizeBytes == 1000);
    CHECK(las.header.vlrs[0].offsetBytes == at + 60);
    put(bytes, atGlobalEncoding, std::uint16_t{4}); // packets are in a file of their own
    CHECK(requireLas(bytes).header.vlrs.empty());
}

TEST_CASE("LAZ is recognised by its bit or its record, and needs the record") {
    auto refusal = [](const Bytes& bytes) {
        MemorySource source(bytes, "test.laz");
        auto reader = las::Reader::open(source);
        REQUIRE_FALSE(reader.ok());
        return reader.error();
    };
    Bytes bytes = lasBytes({2, 1, 5});
    put(bytes, atPointFormat, std::uint8_t{129});
    CHECK(refusal(bytes).code == ErrorCode::corrupt);
    CHECK(refusal(bytes).what ==
          "the point format says that the points are compressed, but no record says how");
    LasRecipe recipe{2, 1, 5};
    recipe.vlrs = {record("laszip encoded", 22204, 46)};
    recipe.vlrs[0].data.assign(46, 0);
    Error error = refusal(lasBytes(recipe));
    CHECK(error.code == ErrorCode::unsupported);
    CHECK(error.sentence() == "test.laz, byte 281, the \"laszip encoded\" record: compressor 0 is not known "
                              "(1 to 3 are) (write the file again with a current LASzip)");
}

TEST_CASE("bounds that lie are told from bounds that were rounded") {
    las::Header header;
    header.grid = {{0.01, 0.01, 0.01}, {100, 200, 300}};
    BoxI found;
    found.extend(Vec3i{0, 0, 0});
    found.extend(Vec3i{1000, 2000, 3000});
    header.bounds.min = {100, 200, 300};
    header.bounds.max = {110, 220, 330};
    CHECK(!las::boundsContradiction(header, found));
    header.bounds.max.x = 110.009;
    CHECK(!las::boundsContradiction(header, found));
    header.bounds.max.x = 110.02;
    CHECK(las::boundsContradiction(header, found).value() ==
          "the header gives x from 100 to 110.02, but the points lie from 100 to 110");
    header.bounds.max = {110, 220, std::nan("")};
    CHECK(las::boundsContradiction(header, found).has_value());
    CHECK(!las::boundsContradiction(header, BoxI{}));
}

TEST_CASE("text that is not UTF-8 becomes readable") {
    Bytes bytes = lasBytes({});
    const char latin[] = "Vermessung M\xFCller";
    std::memcpy(bytes.data() + 26, latin, sizeof latin);
    std::memcpy(bytes.data() + 58, "a\tb\x01z", 6);
    LasContents las = requireLas(bytes);
    CHECK(las.header.systemIdentifier == "Vermessung M\xC3\xBCller");
    CHECK(las.header.generatingSoftware == "a b z");
}
