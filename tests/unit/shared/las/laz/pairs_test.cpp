// Files that LASzip wrote, beside the LAS files they were made of.
#include "shared/io/file_source.hpp"
#include "shared/las/header_block.hpp"
#include "shared/las/laz/chunk_reader.hpp"
#include "tests/support/data.hpp"
#include "tests/unit/shared/las/laz/laz_bytes.hpp"

using namespace stipple;
using namespace stipple::test;

namespace {

constexpr const char* pairs[] = {
    "1815",        "autzen_trim", "extrabytes",       "no-points-1.3", "pdrf4-1.3",
    "pdrf5-1.3",   "pdrf6-1.4",   "pdrf7-v4-1.4",     "pdrf8-1.4",     "pdrf9-1.4",
    "pdrf10-1.4",  "point-color", "point-color-time", "point-time",    "point10-1.0",
    "point10-1.1", "point10",
};

struct OpenFile {
    std::unique_ptr<ByteSource> source;
    std::unique_ptr<las::Reader> reader;
};

OpenFile openFile(const std::string& name) {
    OpenFile file;
    auto source = openFileSource(dataPath(name));
    REQUIRE(source.ok());
    file.source = std::move(*source);
    auto reader = las::Reader::open(*file.source);
    INFO((reader.ok() ? "" : reader.error().sentence()));
    REQUIRE(reader.ok());
    file.reader = std::move(*reader);
    return file;
}

PointBatch readPoints(las::Reader& reader, std::uint64_t first, std::uint64_t count) {
    PointBatch points;
    Status read = reader.read(first, count, points);
    INFO((read.ok() ? "" : read.error().sentence()));
    REQUIRE(read.ok());
    return points;
}

void requireSame(const PointBatch& a, const PointBatch& b) {
    CHECK(a.positions == b.positions);
    CHECK(a.columns == b.columns);
}

} // namespace

TEST_CASE("a LAZ file gives every bit of its LAS twin", "[laz]") {
    STIPPLE_NEEDS_DATA();
    for (const char* name : pairs) {
        CAPTURE(name);
        OpenFile las = openFile(std::string("las-pairs/") + name + ".las");
        OpenFile laz = openFile(std::string("las-pairs/") + name + ".laz");
        CHECK(laz.reader->header().compressed);
        CHECK(laz.reader->schema() == las.reader->schema());
        CHECK(laz.reader->warnings() == las.reader->warnings());
        REQUIRE(laz.reader->pointCount() == las.reader->pointCount());
        requireSame(readPoints(*laz.reader, 0, ~0ull), readPoints(*las.reader, 0, ~0ull));
    }
}

TEST_CASE("reading a LAZ file may begin anywhere and go on", "[laz]") {
    STIPPLE_NEEDS_DATA();
    for (const char* name : {"pdrf5-1.3", "pdrf10-1.4"}) {
        CAPTURE(name);
        OpenFile las = openFile(std::string("las-pairs/") + name + ".las");
        OpenFile laz = openFile(std::string("las-pairs/") + name + ".laz");
        auto starts = laz.reader->chunkStarts();
        CHECK(std::vector<std::uint64_t>(starts.begin(), starts.end()) ==
              std::vector<std::uint64_t>{0, 256, 512, 768});
        CHECK(las.reader->chunkStarts().empty());
        constexpr std::uint64_t places[][2] = {{700, 200}, {900, 24}, {924, 100}, {1024, 5},  {255, 2},
                                               {257, 600}, {0, 1},    {512, 256}, {768, 256}, {3, 0}};
        for (auto [first, count] : places)
            requireSame(readPoints(*laz.reader, first, count), readPoints(*las.reader, first, count));
        PointBatch points;
        CHECK(laz.reader->read(1025, 1, points).error().code == ErrorCode::outOfRange);
    }
}

TEST_CASE("readers of one LAZ file share what opening it cost", "[laz]") {
    STIPPLE_NEEDS_DATA();
    OpenFile laz = openFile("las-pairs/autzen_trim.laz");
    auto source = openFileSource(dataPath("las-pairs/autzen_trim.laz"));
    REQUIRE(source.ok());
    auto another = laz.reader->openAnother(**source);
    REQUIRE(another.ok());
    CHECK((*another)->pointCount() == 110000);
    requireSame(readPoints(**another, 50000, 60000), readPoints(*laz.reader, 50000, 60000));
    auto other = openFileSource(dataPath("las-pairs/1815.laz"));
    REQUIRE(other.ok());
    CHECK(laz.reader->openAnother(**other).error().code == ErrorCode::changed);
}

TEST_CASE("the points of a LASzip file are compressed to the bytes that LASzip wrote", "[laz]") {
    STIPPLE_NEEDS_DATA();
    for (const char* name :
         {"las-pairs/1815.laz", "las-pairs/autzen_trim.laz", "las-pairs/extrabytes.laz",
          "las-pairs/pdrf4-1.3.laz", "las-pairs/pdrf5-1.3.laz", "las-pairs/pdrf6-1.4.laz",
          "las-pairs/pdrf7-v4-1.4.laz", "las-pairs/pdrf8-1.4.laz", "las-pairs/pdrf9-1.4.laz",
          "las-pairs/pdrf10-1.4.laz", "las-pairs/point10.laz", "las-pairs/point10-1.0.laz"}) {
        CAPTURE(name);
        OpenFile laz = openFile(name);
        std::vector<std::string> warnings;
        const std::uint64_t end = laz.source->sizeBytes();
        auto index = las::laz::readChunkIndex(*laz.source, laz.reader->header(), end, warnings);
        REQUIRE(index.ok());
        las::laz::ChunkReader chunks(*laz.source, std::make_shared<las::laz::ChunkIndex>(*index));
        for (std::size_t c = 0; c + 1 < index->starts.size(); ++c) {
            const auto points = static_cast<std::size_t>(index->starts[c + 1] - index->starts[c]);
            Bytes records(points * index->recordLength);
            REQUIRE(chunks.seek(index->starts[c]).ok());
            REQUIRE(chunks.read(records).ok());
            auto original =
                readNow(*laz.source, {index->offsets[c], index->offsets[c + 1] - index->offsets[c]});
            REQUIRE(original.ok());
            CHECK(encodeChunk(index->record, records) == *original);
        }
    }
}

TEST_CASE("a file of LASzip 1.2 is decoded", "[laz]") {
    STIPPLE_NEEDS_DATA();
    auto source = openFileSource(dataPath("las-odd/broken_coder.laz"));
    REQUIRE(source.ok());
    auto bytes = readNow(**source, {0, 1000});
    REQUIRE(bytes.ok());
    // The first bytes of a real file whose record was damaged: it is pointwise, of version 1.
    const std::string user = "laszip encoded";
    auto record = std::search(bytes->begin(), bytes->end(), user.begin(), user.end());
    const auto coder = static_cast<std::size_t>(record - bytes->begin()) - 2 + las::vlrHeaderSize + 2;
    storeLe(bytes->data() + coder, std::uint16_t{0});
    MemorySource mended(*bytes);
    auto reader = las::Reader::open(mended);
    REQUIRE(reader.ok());
    const las::Header& header = (*reader)->header();
    const int time = (*reader)->schema().find(attribute_names::gpsTime);
    PointBatch points;
    REQUIRE((*reader)->read(0, 92, points).ok());
    double last = 413162.5604;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3d world = header.grid.toWorld(points.positions[i]);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(world[axis] >= header.bounds.min[axis]);
            CHECK(world[axis] <= header.bounds.max[axis]);
        }
        CHECK(points.value<double>(time, i) >= last);
        last = points.value<double>(time, i);
    }
    CHECK(last < 413162.64);
    CHECK((*reader)->read(92, 1, points).error().code == ErrorCode::truncated);
}

TEST_CASE("real LAZ clouds lie inside the bounds of their headers", "[laz][slow]") {
    STIPPLE_NEEDS_DATA();
    for (const char* name : {"autzen.laz", "lion_takanawa.copc.laz", "lone-star.laz", "indoor.laz",
                             "ign_extra_bytes_pdrf8.laz"}) {
        CAPTURE(name);
        OpenFile laz = openFile(std::string("clouds/") + name);
        BoxI box;
        for (std::uint64_t first = 0; first < laz.reader->pointCount(); first += 100000)
            for (Vec3i p : readPoints(*laz.reader, first, 100000).positions)
                box.extend(p);
        // The bounds of lone-star.laz were rounded to ten steps of its grid.
        const las::Header& header = laz.reader->header();
        for (int axis = 0; axis < 3; ++axis) {
            double margin = 10.5 * header.grid.scale[axis];
            CHECK(std::abs(header.grid.toWorld(box.min)[axis] - header.bounds.min[axis]) < margin);
            CHECK(std::abs(header.grid.toWorld(box.max)[axis] - header.bounds.max[axis]) < margin);
        }
    }
}

TEST_CASE("LASzip records that contradict themselves are refused", "[laz]") {
    STIPPLE_NEEDS_DATA();
    auto refusal = [](const char* name) {
        auto source = openFileSource(dataPath(std::string("las-odd/") + name));
        REQUIRE(source.ok());
        auto reader = las::Reader::open(**source);
        REQUIRE_FALSE(reader.ok());
        CHECK(reader.error().code == ErrorCode::unsupported);
        return reader.error().what;
    };
    CHECK(refusal("broken_coder.laz") == "coder 15 is not known (0, arithmetic coding, is the only one)");
    CHECK(refusal("broken_size.laz") == "item 0 (POINT10) has version 6, which is not known");
    CHECK(refusal("broken_version.laz") == "item 0 (POINT10) has version 6, which is not known");
}
