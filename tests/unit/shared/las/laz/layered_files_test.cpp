// Files of other software: the points of each .laz equal those of its .las, and our encoder makes the very
// bytes that LASzip, PDAL and TerraScan wrote.
#include "shared/io/file_source.hpp"
#include "shared/las/las_reader.hpp"
#include "tests/support/data.hpp"
#include "tests/unit/shared/las/laz/layered_points.hpp"

#include <algorithm>

using namespace stipple;
using namespace stipple::test;
using namespace stipple::las::laz;

namespace {

struct PointFile {
    Bytes bytes;
    las::Header header;
    Items items; // of .laz
};

PointFile openFile(const std::string& name) {
    auto source = openFileSource(dataPath(name));
    REQUIRE(source.ok());
    auto bytes = readNow(**source, {0, (*source)->sizeBytes()});
    REQUIRE(bytes.ok());
    auto reader = las::Reader::open(**source);
    REQUIRE(reader.ok());
    PointFile file{std::move(*bytes), (*reader)->header(), {}};
    for (const las::Vlr& vlr : file.header.vlrs) {
        if (!vlr.is("laszip encoded", 22204))
            continue;
        ByteReader record(vlr.data);
        record.skip(32);
        for (unsigned left = record.read<std::uint16_t>(); left > 0; --left) {
            const auto type = static_cast<ItemType>(record.read<std::uint16_t>());
            const auto size = record.read<std::uint16_t>();
            file.items.push_back({type, size, record.read<std::uint16_t>()});
        }
    }
    return file;
}

std::size_t layersOf(const Items& items) {
    std::size_t layers = 9;
    for (const Item& item : items)
        layers += item.type == ItemType::point14    ? 0u
                  : item.type == ItemType::rgbNir14 ? 2u
                  : item.type == ItemType::byte14   ? item.sizeBytes
                                                    : 1u;
    return layers;
}

// Decodes chunk after chunk, each of which says how long it is, and compares what encoding makes of it.
// `points`: the .las file's, or empty.
void checkFile(PointFile& file, ByteSpan points) {
    const std::size_t recordLength = file.header.recordLength, layers = layersOf(file.items);
    std::size_t at = file.header.pointDataOffset + 8;
    file.bytes.resize(file.bytes.size() + decodePadding(recordLength));
    auto decoder = makeLayeredDecoder(file.items, {});
    auto encoder = makeLayeredEncoder(file.items);
    REQUIRE(decoder.ok());
    REQUIRE(encoder.ok());
    Bytes records;
    std::size_t done = 0, wrongChunks = 0, wrongPoints = 0;
    while (done < file.header.pointCount) {
        const std::uint8_t* head = file.bytes.data() + at + recordLength;
        const auto count = loadLe<std::uint32_t>(head);
        std::size_t size = recordLength + 4 + 4 * layers;
        for (std::size_t i = 0; i < layers; ++i)
            size += loadLe<std::uint32_t>(head + 4 + 4 * i);
        ByteSpan chunk(file.bytes.data() + at, size);
        REQUIRE((*decoder)->start(chunk, count).ok());
        records.resize(count * recordLength);
        REQUIRE((*decoder)->decode(records).ok());
        if (!points.empty())
            wrongPoints += !std::equal(records.begin(), records.end(),
                                       points.begin() + static_cast<std::ptrdiff_t>(done * recordLength));
        (*encoder)->start();
        (*encoder)->encode(records);
        ByteSpan again = (*encoder)->finish();
        wrongChunks += !std::equal(again.begin(), again.end(), chunk.begin(), chunk.end());
        at += size;
        done += count;
    }
    CHECK(done == file.header.pointCount);
    CHECK(wrongPoints == 0);
    CHECK(wrongChunks == 0);
}

} // namespace

TEST_CASE("layered files of other software decode to their LAS twins and encode to the same bytes") {
    STIPPLE_NEEDS_DATA();
    for (const char* name : {"pdrf6-1.4", "pdrf7-v4-1.4", "pdrf8-1.4", "pdrf9-1.4", "pdrf10-1.4"}) {
        INFO(name);
        PointFile laz = openFile("las-pairs/" + std::string(name) + ".laz");
        PointFile las = openFile("las-pairs/" + std::string(name) + ".las");
        REQUIRE(laz.header.pointCount == 1024);
        checkFile(laz,
                  ByteSpan(las.bytes).subspan(las.header.pointDataOffset, 1024u * las.header.recordLength));
    }
}

TEST_CASE("clouds in layered files encode to the same bytes once decoded") {
    STIPPLE_NEEDS_DATA();
    for (const char* name : {"ign_extra_bytes_pdrf8.laz", "lion_takanawa.copc.laz"}) {
        INFO(name);
        PointFile laz = openFile("clouds/" + std::string(name));
        checkFile(laz, {});
    }
}

TEST_CASE("a file of random points survives layered coding") {
    STIPPLE_NEEDS_DATA();
    PointFile las = openFile("las-pairs/rand1_6.las");
    ByteSpan records = ByteSpan(las.bytes).subspan(las.header.pointDataOffset, 50000 * 30);
    auto decoded = decodeLayered({6, 0, 3}, encodeLayered({6, 0, 3}, records), 50000);
    REQUIRE(decoded.ok());
    CHECK(std::equal(decoded->begin(), decoded->end(), records.begin(), records.end()));
}
