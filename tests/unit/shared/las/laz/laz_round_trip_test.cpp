// What is compressed and read again is the same, bit for bit.
#include "tests/unit/shared/las/laz/laz_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

Bytes recordsFor(const LasRecipe& recipe, bool smooth) {
    return smooth ? smoothRecords(recipe.pointFormat, recipe.extraBytes, recipe.points)
                  : randomRecords(recipe);
}

void requireSamePoints(const LasContents& laz, const LasContents& las) {
    CHECK(laz.schema == las.schema);
    CHECK(laz.points.positions == las.points.positions);
    CHECK(laz.points.columns == las.points.columns);
}

void requireReads(const LazRecipe& recipe, bool smooth) {
    const Bytes records = recordsFor(recipe.las, smooth);
    LasContents laz = requireLas(lazBytes(recipe, records));
    CHECK(laz.warnings.empty());
    CHECK(laz.header.compressed);
    requireSamePoints(laz, requireLas(lasBytes(recipe.las, records)));
}

} // namespace

TEST_CASE("LAZ of every format, written and read again, is what it was", "[laz]") {
    for (int format = 0; format <= 10; ++format)
        for (std::size_t extra : {0u, 5u})
            for (std::size_t points : {0u, 1u, 2u, 3000u})
                for (bool smooth : {false, true}) {
                    CAPTURE(format, extra, points, smooth);
                    LasRecipe recipe = lazRecipe(format, extra, points, 1).las;
                    LasContents las = requireLas(lasBytes(recipe, recordsFor(recipe, smooth)));
                    las::WriterOptions options;
                    options.grid = las.header.grid;
                    options.schema = las.schema;
                    options.pointFormat = format;
                    options.versionMinor = recipe.versionMinor;
                    options.compressed = true;
                    auto written = writeLas(options, las.points);
                    REQUIRE(written.ok());
                    LasContents laz = requireLas(*written);
                    CHECK(laz.warnings.empty());
                    CHECK(laz.header.compressed);
                    CHECK(laz.header.pointFormat == format);
                    CHECK(laz.header.recordLength == las.header.recordLength);
                    requireSamePoints(laz, las);
                    if (points == 3000 && smooth)
                        CHECK(written->size() < points * las.header.recordLength);
                }
}

TEST_CASE("LAZ is written chunk after chunk, whatever the batches are", "[laz]") {
    for (int format : {3, 7}) {
        CAPTURE(format);
        LasRecipe recipe = lazRecipe(format, 2, 120001, 1).las;
        LasContents las = requireLas(lasBytes(recipe, recordsFor(recipe, true)));
        las::WriterOptions options;
        options.grid = las.header.grid;
        options.schema = las.schema;
        options.pointFormat = format;
        options.compressed = true;
        auto whole = writeLas(options, las.points);
        REQUIRE(whole.ok());
        TemporaryFolder folder;
        auto writer = las::Writer::create(folder.file("out.laz"), options);
        REQUIRE(writer.ok());
        MemorySource source(lasBytes(recipe, recordsFor(recipe, true)));
        auto reader = las::Reader::open(source);
        REQUIRE(reader.ok());
        for (std::uint64_t first = 0; first < 120001; first += 7919) {
            PointBatch part;
            REQUIRE((*reader)->read(first, 7919, part).ok());
            REQUIRE((*writer)->write(part).ok());
        }
        REQUIRE((*writer)->finish().ok());
        CHECK(fileBytes(folder.file("out.laz")) == *whole);

        MemorySource written(*whole);
        auto again = las::Reader::open(written);
        REQUIRE(again.ok());
        auto starts = (*again)->chunkStarts();
        CHECK(std::vector<std::uint64_t>(starts.begin(), starts.end()) ==
              std::vector<std::uint64_t>{0, 50000, 100000});
        requireSamePoints(requireLas(*whole), las);
    }
}

TEST_CASE("files of LASzip 1 are read: items of version 1, without chunks or with them", "[laz]") {
    for (int format = 0; format <= 5; ++format)
        for (std::size_t extra : {0u, 3u})
            for (bool smooth : {false, true}) {
                CAPTURE(format, extra, smooth);
                LazRecipe chunked = firstVersion(lazRecipe(format, extra, 2000, 700));
                requireReads(chunked, smooth);
                LazRecipe whole = chunked;
                whole.record.compressor = las::laz::Compressor::pointwise;
                whole.record.chunkSize = 0;
                requireReads(whole, smooth);
                whole.las.points = 0;
                requireReads(whole, smooth);
            }
}

TEST_CASE("chunks of any number of points are read, and a table at the end of the file", "[laz]") {
    for (int format : {1, 2, 5, 6, 8, 10})
        for (TablePlace place : {TablePlace::front, TablePlace::end}) {
            CAPTURE(format, static_cast<int>(place));
            LazRecipe fixed = lazRecipe(format, 4, 1000, 300);
            fixed.table = place;
            requireReads(fixed, true);
            LazRecipe variable = lazRecipe(format, 4, 1000, las::laz::variableChunkSize);
            variable.variableChunks = {1, 500, 3, 0x7FFFFFFF};
            variable.table = place;
            requireReads(variable, true);
            MemorySource source(lazBytes(variable, recordsFor(variable.las, true)));
            auto reader = las::Reader::open(source);
            REQUIRE(reader.ok());
            auto starts = (*reader)->chunkStarts();
            CHECK(std::vector<std::uint64_t>(starts.begin(), starts.end()) ==
                  std::vector<std::uint64_t>{0, 1, 501, 504});
        }
}

TEST_CASE("without a chunk table the points are read one chunk after the other", "[laz]") {
    for (int format : {0, 3, 5, 6, 7, 10}) {
        CAPTURE(format);
        LazRecipe recipe = lazRecipe(format, 2, 1000, 300);
        recipe.table = TablePlace::absent;
        const Bytes records = recordsFor(recipe.las, true);
        LasContents laz = requireLas(lazBytes(recipe, records));
        CHECK(anyContains(laz.warnings, "the points are read without it"));
        requireSamePoints(laz, requireLas(lasBytes(recipe.las, records)));

        // Going back and forth, too.
        MemorySource source(lazBytes(recipe, records)), plain(lasBytes(recipe.las, records));
        auto reader = las::Reader::open(source), expected = las::Reader::open(plain);
        REQUIRE(reader.ok());
        REQUIRE(expected.ok());
        auto starts = (*reader)->chunkStarts();
        CHECK(starts.size() == (format >= 6 ? 4 : 1));
        for (std::uint64_t first : {700u, 100u, 950u, 0u, 300u}) {
            PointBatch a, b;
            REQUIRE((*reader)->read(first, 90, a).ok());
            REQUIRE((*expected)->read(first, 90, b).ok());
            CHECK(a.positions == b.positions);
            CHECK(a.columns == b.columns);
        }
        recipe.record.chunkSize = las::laz::variableChunkSize;
        recipe.variableChunks = {10, 900, 500};
        auto variable = readLas(lazBytes(recipe, records));
        CHECK(variable.ok() == (format >= 6));
        if (!variable.ok())
            CHECK(variable.error().code == ErrorCode::corrupt);
        else
            requireSamePoints(*variable, requireLas(lasBytes(recipe.las, records)));
    }
}

TEST_CASE("pointwise chunks larger than the window are decoded through it", "[laz]") {
    // 1000 extra bytes at random: nothing is saved, and a chunk has 5 MB.
    for (std::uint16_t version : {std::uint16_t{1}, std::uint16_t{2}}) {
        CAPTURE(version);
        LazRecipe recipe = lazRecipe(1, 1000, 6000, 5000);
        if (version == 1)
            recipe = firstVersion(recipe);
        requireReads(recipe, false);
        recipe.table = TablePlace::absent;
        const Bytes records = recordsFor(recipe.las, false);
        requireSamePoints(requireLas(lazBytes(recipe, records)), requireLas(lasBytes(recipe.las, records)));
    }
}

TEST_CASE("only the chosen attributes of layered points are decoded", "[laz]") {
    LazRecipe recipe = lazRecipe(8, 4, 3000, 1000);
    const Bytes records = recordsFor(recipe.las, true);
    LasContents las = requireLas(lasBytes(recipe.las, records));
    MemorySource source(lazBytes(recipe, records));
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    const std::vector<std::string> chosen{"Intensity", "NIR", "Extra Bytes"};
    PointBatch points;
    REQUIRE((*reader)->read(0, 1500, points).ok()); // in the middle of a chunk
    (*reader)->select(chosen);
    REQUIRE((*reader)->read(0, 3000, points).ok());
    CHECK(points.positions == las.points.positions);
    for (std::size_t a = 0; a < las.schema.attributes.size(); ++a) {
        const std::string& name = las.schema.attributes[a].name;
        CAPTURE(name);
        const bool always =
            name == "Return Number" || name == "Number of Returns" || name == "Scanner Channel";
        if (always || std::find(chosen.begin(), chosen.end(), name) != chosen.end())
            CHECK(points.columns[a] == las.points.columns[a]);
        else
            CHECK(points.columns[a] == Bytes(points.columns[a].size()));
    }
}
