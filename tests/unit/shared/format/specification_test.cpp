// docs/FORMAT.md is the specification: the bytes it shows are read from it and given to the code. And a file
// of each version, frozen when the version was, must give the same points for ever.
#include "shared/codec/colour_codec.hpp"
#include "shared/codec/column_codec.hpp"
#include "shared/codec/exact_colour.hpp"
#include "shared/codec/position_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "shared/codec/section.hpp"
#include "shared/codec/varint.hpp"
#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/unit/shared/format/sample_file.hpp"

#include <cstdlib>
#include <fstream>
#include <sstream>

using namespace stipple;
using namespace stipple::test;

namespace {

// The example of that name: the hexadecimal bytes left of the bars in a block that begins ```bytes NAME.
Bytes example(const std::string& name) {
    std::ifstream file(STIPPLE_SOURCE_DIR "/docs/FORMAT.md");
    REQUIRE(file.good());
    Bytes bytes;
    bool inside = false;
    for (std::string line; std::getline(file, line);) {
        if (line == "```bytes " + name)
            inside = true;
        else if (line == "```")
            inside = false;
        else if (inside) {
            std::istringstream words(line.substr(0, line.find('|')));
            for (std::string word; words >> word;)
                bytes.push_back(static_cast<std::uint8_t>(std::strtoul(word.c_str(), nullptr, 16)));
        }
    }
    if (bytes.empty())
        FAIL("docs/FORMAT.md has no example named " << name);
    return bytes;
}

std::string hex(const Bytes& bytes) {
    std::string text;
    char two[4];
    for (std::uint8_t byte : bytes) {
        std::snprintf(two, sizeof two, "%02X ", byte);
        text += two;
    }
    return text;
}

using Points = std::vector<Vec3<std::uint32_t>>;
const Points fivePoints{{1, 2, 3}, {5, 0, 0}, {5, 0, 0}, {7, 7, 7}, {0, 0, 1}};
const std::vector<std::uint16_t> fiveColours{10, 20, 30, 11, 21, 31, 12, 20, 30, 12, 20, 29, 200, 100, 50};

// Made-up scan: a slope with colours, pulses of up to two returns, noise in the intensities.
PointBatch scanPoints(const CloudMetadata& metadata, NodeKey key, std::uint32_t count) {
    PointBatch points = randomPoints(metadata, key, count, 77);
    Vec3i corner = metadata.rootCube.nodeMin(key);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::uint32_t x = i * 2654435761u >> 20, y = i * 2246822519u >> 20;
        points.positions[i] = corner + Vec3i{x, y, (x + y) / 64 + i % 3};
        int a = 0;
        for (const Attribute& attribute : metadata.schema.attributes) {
            if (attribute.type == AttributeType::u16 && attribute.components == 1)
                points.setValue<std::uint16_t>(a, i, static_cast<std::uint16_t>((x / 20 + i * 7 % 5) % 256));
            if (attribute.name == attribute_names::gpsTime)
                points.setValue<double>(a, i, 3e8 + 1e-5 * (i / 2));
            if (attribute.name == attribute_names::returnNumber ||
                attribute.name == attribute_names::numberOfReturns)
                points.setValue<std::uint8_t>(a, i, static_cast<std::uint8_t>(1 + i % 2));
            ++a;
        }
    }
    return points;
}

} // namespace

TEST_CASE("the specification's varints, sections and frames are what the code reads and writes") {
    Bytes bytes = example("varint");
    ByteReader from(bytes);
    for (std::uint64_t value : {0, 127, 128, 300})
        CHECK(readVarint(from) == value);

    ByteWriter section;
    writeSection(section, Bytes{7, 8, 9}, Effort::literals);
    CHECK(hex(section.bytes()) == hex(example("stored section")));
    Bytes compressed = example("compressed section"), zeros(1000, 1);
    ByteReader reader(compressed);
    CHECK(readFullSection(reader, zeros).ok());
    CHECK(zeros == Bytes(1000));

    CHECK(hex(frameBlock(Bytes{7, 8, 9})) == hex(example("frame")));
}

TEST_CASE("the specification's header is what the code reads and writes") {
    FileHeader header = need(parseFileHeader(example("header")));
    CHECK(header.fileBytes == 123456);
    CHECK(header.metadata == ByteRange{64, 2000});
    CHECK(header.rootChunk == ByteRange{2064, 300});
    CHECK(hex(writeFileHeader(header)) == hex(example("header")));
}

TEST_CASE("the specification's hierarchy chunk is what the code reads and writes") {
    CloudMetadata metadata;
    metadata.rootCube.bits = 10;
    metadata.schema.attributes.push_back(attributeOf("Classification", AttributeType::u8));
    NodeEntry root, child;
    root.childMask = 0x20;
    root.pointCount = 1000;
    root.strataBytes = {400, 390, 760, 1500};
    root.attributeBytes = {100};
    child.key = {1, 1, 0, 1};
    child.pointCount = 500;
    child.strataBytes = {210, 200, 380, 740};
    child.attributeBytes = {0};
    CHECK(hex(writeHierarchyChunk({true, {}, 0, {root, child}, 2364, 6000})) ==
          hex(example("hierarchy chunk")));
    auto nodes = need(parseHierarchyChunk(metadata, 10000, example("hierarchy chunk")));
    REQUIRE(nodes.size() == 2);
    CHECK(nodes[0].strataBytes == root.strataBytes);
    CHECK(nodes[1].key == child.key);
    CHECK(nodes[1].strataBytes == child.strataBytes);
    CHECK(nodes[1].offsetBytes == 2364 + 400 + 390 + 760 + 1500 + 100);
}

TEST_CASE("the specification's positions are what the code reads and writes") {
    SortedPoints sorted = sortPoints(fivePoints);
    PositionDecoder decoder(5, 3, strataCount);
    for (int s = 0; s < strataCount; ++s) {
        Bytes bytes = example("positions of stratum " + std::to_string(s));
        ByteWriter to;
        encodePositions(to, sorted, s);
        CHECK(hex(to.bytes()) == hex(bytes));
        ByteReader from(bytes);
        REQUIRE(decoder.decode(s, from).ok());
    }
    CHECK(need(decoder.takePositions()) == Points{{0, 0, 1}, {7, 7, 7}, {5, 0, 0}, {1, 2, 3}, {5, 0, 0}});
}

TEST_CASE("the specification's colours are what the code reads and writes") {
    SortedPoints sorted = sortPoints(fivePoints);
    ColourDecoder decoder(5, 3, strataCount);
    for (int s = 0; s < strataCount; ++s) {
        Bytes bytes = example("colours of stratum " + std::to_string(s));
        auto choices = neighbourChoices(sorted.keys, s);
        ByteWriter to;
        encodeColour(to, fiveColours, 3, narrowestWidth(fiveColours), s, choices);
        CHECK(hex(to.bytes()) == hex(bytes));
        ByteReader from(bytes);
        REQUIRE(decoder.decode(s, from, choices).ok());
    }
    CHECK(decoder.takeValues() ==
          std::vector<std::uint16_t>{10, 20, 30, 200, 100, 50, 12, 20, 30, 11, 21, 31, 12, 20, 29});
}

TEST_CASE("the specification's exact colours are what the code reads and writes") {
    // In Morton order, as sorted.
    const std::vector<std::uint16_t> exact{10, 20, 30, 11, 21, 31, 12, 20, 30, 12, 20, 29, 200, 100, 50};
    std::vector<std::uint16_t> shown{11, 20, 30, 11, 20, 30, 12, 20, 30, 12, 20, 29, 180, 90, 48};
    Bytes bytes = example("exact colours");
    ByteWriter to;
    writeExactColour(to, exact, shown, 3, narrowestWidth(exact));
    CHECK(hex(to.bytes()) == hex(bytes));
    ByteReader from(bytes);
    std::vector<std::uint32_t> order{0, 1, 2, 3, 4};
    REQUIRE(readExactColour(from, order, 3, shown).ok());
    CHECK(shown == exact);
}

TEST_CASE("the specification's columns are what the code reads and writes") {
    Bytes constant(6, 4), values{1, 0, 2, 0, 250, 0};
    ByteWriter to;
    encodeColumn(to, constant, 2, 1);
    CHECK(hex(to.bytes()) == hex(example("constant column")));
    Bytes planes = example("column of planes"), ranked = example("ranked column");
    ByteReader fromPlanes(planes), fromRanked(ranked);
    CHECK(need(decodeColumn(fromPlanes, 3, 2, 1)) == values);
    CHECK(need(decodeColumn(fromRanked, 3, 2, 1)) == values);
}

namespace {

// Two nodes of points and, in version 2, what the first shows instead of its colours.
struct Frozen {
    CloudMetadata metadata = sampleMetadata();
    PointBatch root, child;
    std::vector<std::uint16_t> shown;
    PointHash hash;

    explicit Frozen(std::uint32_t version) {
        metadata.name = "frozen";
        PointBatch noise = randomPoints(metadata, version == 1 ? NodeKey{} : childKey, 8, 3),
                   scan = scanPoints(metadata, version == 1 ? childKey : NodeKey{}, 300);
        root = version == 1 ? noise : scan;
        child = version == 1 ? scan : noise;
        if (version == 2) {
            metadata.innerColour = InnerColour::mean;
            int red = metadata.schema.find(attribute_names::red);
            for (std::size_t i = 0; i < 3 * root.size(); ++i)
                shown.push_back(static_cast<std::uint16_t>(
                    root.value<std::uint16_t>(red + static_cast<int>(i % 3), i / 3) / 2 + i % 7));
        }
        metadata.pointCount = root.size() + child.size();
        hash = hashOf(metadata, root);
        hash.add(hashOf(metadata, child));
        metadata.pointHash = hash.hex();
    }
    void write(const std::string& path) const {
        auto writer = need(CloudWriter::create(path));
        need(writer->add(need(encodeNode(metadata, {}, root, shown))));
        need(writer->add(need(encodeNode(metadata, childKey, child))));
        need(writer->finish(metadata));
    }
    static constexpr NodeKey childKey{1, 0, 1, 0};
};

} // namespace

TEST_CASE("a frozen file of each version gives the points that it was made of") {
    for (std::uint32_t version : {1u, 2u}) {
        std::string path =
            STIPPLE_SOURCE_DIR "/tests/unit/shared/format/frozen/v" + std::to_string(version) + ".stipple";
        Frozen frozen(version);
        const char* freeze = std::getenv("STIPPLE_FREEZE"); // the version; once for each
        if (freeze != nullptr && freeze == std::to_string(version))
            frozen.write(path);
        auto source = need(openFileSource(path));
        auto reader = need(CloudReader::open(*source));
        PointHash read;
        need(reader->visitNodes([&](const NodeEntry& entry) -> Status {
            STIPPLE_TRY(batch, reader->readNode(entry));
            read.add(frozen.metadata.schema, batch);
            if (version == 1 || entry.key.level > 0)
                return {};
            STIPPLE_TRY(strata, readNow(*source, entry.strataRange(strataCount)));
            STIPPLE_TRY(picture, decodePicture(reader->metadata(), entry, strataCount, strata));
            std::sort(picture.colour.begin(), picture.colour.end());
            std::sort(frozen.shown.begin(), frozen.shown.end());
            CHECK(picture.colour == frozen.shown);
            return {};
        }));
        CHECK(reader->header().version == version);
        CHECK(reader->metadata().name == "frozen");
        CHECK(reader->metadata().pointHash == frozen.hash.hex());
        CHECK(read == frozen.hash);
    }
}
