// LAS files laid out byte by byte for tests, without the writer that is under test.
#pragma once

#include "shared/io/memory_source.hpp"
#include "shared/las/las_reader.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <random>
#include <string>

namespace stipple::test {

// Byte positions in the header block.
enum HeaderByte : std::size_t {
    atGlobalEncoding = 6,
    atVersionMinor = 25,
    atHeaderSize = 94,
    atPointDataOffset = 96,
    atVlrCount = 100,
    atPointFormat = 104,
    atRecordLength = 105,
    atLegacyCount = 107,
    atScale = 131,
    atBounds = 179,
    atWaveform = 227,
    atEvlrOffset = 235,
    atEvlrCount = 243,
    atCount = 247,
};

struct LasRecipe {
    int versionMinor = 2;
    int pointFormat = 0;
    std::size_t points = 3;
    std::size_t extraBytes = 0;   // bytes after the format's fields
    std::vector<las::Vlr> vlrs{}; // extended ones after the points
    Bytes beforePoints{};         // between records and points
    std::uint32_t seed = 1;
};

// The record `i` of a recipe: every bit of every field random, NaN times among them.
inline Bytes randomRecords(const LasRecipe& recipe) {
    std::mt19937 random(recipe.seed);
    Bytes bytes(recipe.points * (las::pointRecordSize(recipe.pointFormat) + recipe.extraBytes));
    for (std::uint8_t& byte : bytes)
        byte = static_cast<std::uint8_t>(random());
    return bytes;
}

inline void appendVlr(Bytes& to, const las::Vlr& vlr) {
    ByteWriter writer;
    writer.write(std::uint16_t{0});
    writer.writeFixedText(vlr.userId, 16);
    writer.write(vlr.recordId);
    if (vlr.extended)
        writer.write(static_cast<std::uint64_t>(vlr.data.size()));
    else
        writer.write(static_cast<std::uint16_t>(vlr.data.size()));
    writer.writeFixedText(vlr.description, 32);
    writer.writeBytes(vlr.data);
    to.insert(to.end(), writer.bytes().begin(), writer.bytes().end());
}

inline Bytes lasBytes(const LasRecipe& recipe, const Bytes& records) {
    std::size_t headerSize = recipe.versionMinor >= 4 ? 375 : recipe.versionMinor == 3 ? 235 : 227;
    Bytes bytes(headerSize);
    auto put = [&](std::size_t at, auto value) { storeLe(bytes.data() + at, value); };
    std::memcpy(bytes.data(), "LASF", 4);
    put(24, std::uint8_t{1});
    put(25, static_cast<std::uint8_t>(recipe.versionMinor));
    std::memcpy(bytes.data() + 26, "test system", 11);
    std::memcpy(bytes.data() + 58, "las_bytes", 9);
    put(90, std::uint16_t{123});
    put(92, std::uint16_t{2024});
    put(atHeaderSize, static_cast<std::uint16_t>(headerSize));
    put(atPointFormat, static_cast<std::uint8_t>(recipe.pointFormat));
    put(atRecordLength,
        static_cast<std::uint16_t>(las::pointRecordSize(recipe.pointFormat) + recipe.extraBytes));
    if (recipe.pointFormat < 6)
        put(atLegacyCount, static_cast<std::uint32_t>(recipe.points));
    for (std::size_t axis = 0; axis < 3; ++axis) {
        put(atScale + 8 * axis, 0.01);
        put(155 + 8 * axis, 1000.0 * static_cast<double>(axis + 1));
    }
    if (recipe.versionMinor >= 4)
        put(atCount, static_cast<std::uint64_t>(recipe.points));
    std::uint32_t vlrCount = 0, evlrCount = 0;
    for (const las::Vlr& vlr : recipe.vlrs)
        ++(vlr.extended ? evlrCount : vlrCount);
    put(atVlrCount, vlrCount);
    for (const las::Vlr& vlr : recipe.vlrs)
        if (!vlr.extended)
            appendVlr(bytes, vlr);
    bytes.insert(bytes.end(), recipe.beforePoints.begin(), recipe.beforePoints.end());
    put(atPointDataOffset, static_cast<std::uint32_t>(bytes.size()));
    bytes.insert(bytes.end(), records.begin(), records.end());
    if (evlrCount > 0) {
        put(atEvlrOffset, static_cast<std::uint64_t>(bytes.size()));
        put(atEvlrCount, evlrCount);
    }
    for (const las::Vlr& vlr : recipe.vlrs)
        if (vlr.extended)
            appendVlr(bytes, vlr);
    return bytes;
}

inline Bytes lasBytes(const LasRecipe& recipe) {
    return lasBytes(recipe, randomRecords(recipe));
}

// A file read whole.
struct LasContents {
    las::Header header;
    Schema schema;
    std::vector<std::string> warnings;
    PointBatch points;
};

inline Result<LasContents> readLas(ByteSource& source) {
    STIPPLE_TRY(reader, las::Reader::open(source));
    LasContents contents{reader->header(), reader->schema(), reader->warnings(), {}};
    STIPPLE_CHECK(reader->read(0, reader->pointCount(), contents.points));
    return contents;
}
inline Result<LasContents> readLas(Bytes bytes) {
    MemorySource source(std::move(bytes), "test.las");
    return readLas(source);
}
inline LasContents requireLas(Bytes bytes) {
    auto contents = readLas(std::move(bytes));
    if (!contents.ok())
        FAIL(contents.error().sentence());
    return std::move(*contents);
}

inline Bytes fileBytes(const std::string& path) {
    std::string text = fileText(path);
    return Bytes(text.begin(), text.end());
}

// Writes `points` and returns the file's bytes.
inline Result<Bytes> writeLas(const las::WriterOptions& options, const PointBatch& points) {
    TemporaryFolder folder;
    STIPPLE_TRY(writer, las::Writer::create(folder.file("out.las"), options));
    STIPPLE_CHECK(writer->write(points));
    STIPPLE_CHECK(writer->finish());
    return fileBytes(folder.file("out.las"));
}

// The point records of a file, as bytes.
inline Bytes recordBytes(const Bytes& file, const las::Header& header, std::size_t points) {
    auto first = file.begin() + header.pointDataOffset;
    return Bytes(first, first + static_cast<std::ptrdiff_t>(points * header.recordLength));
}

// Reads, writes with the options of the file, reads again.
inline void requireRoundTrip(const Bytes& original) {
    MemorySource source(original);
    auto reader = las::Reader::open(source);
    REQUIRE(reader.ok());
    PointBatch points;
    REQUIRE((*reader)->read(0, (*reader)->pointCount(), points).ok());
    auto written = writeLas(las::optionsLike(**reader), points);
    if (!written.ok())
        FAIL(written.error().sentence());
    LasContents again = requireLas(*written);

    CHECK(again.warnings.empty());
    CHECK(again.schema == (*reader)->schema());
    CHECK(again.points.positions == points.positions);
    CHECK(again.points.columns == points.columns);
    CHECK(again.header.versionMinor == (*reader)->header().versionMinor);
    CHECK(again.header.grid == (*reader)->header().grid);
    CHECK(recordBytes(*written, again.header, points.size()) ==
          recordBytes(original, (*reader)->header(), points.size()));
}

inline bool anyContains(const std::vector<std::string>& sentences, const std::string& part) {
    for (const std::string& sentence : sentences)
        if (sentence.find(part) != std::string::npos)
            return true;
    return false;
}

} // namespace stipple::test
