// Nodes whose picture shows other colours than the points have.
#include "shared/io/memory_source.hpp"
#include "tests/unit/shared/codec/damage.hpp"
#include "tests/unit/shared/format/sample_file.hpp"

#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {

using Values = std::vector<std::uint16_t>;

CloudMetadata meanMetadata() {
    CloudMetadata metadata = sampleMetadata();
    metadata.innerColour = InnerColour::mean;
    return metadata;
}

// Points with colours of 8 bits, and for each something to show that is near its own.
struct ShownPoints {
    PointBatch points;
    Values shown;
};
ShownPoints shownPoints(const CloudMetadata& metadata, NodeKey key, std::size_t count) {
    ShownPoints result{randomPoints(metadata, key, count, 11), {}};
    for (std::size_t i = 0; i < count; ++i)
        for (auto name : {attribute_names::red, attribute_names::green, attribute_names::blue}) {
            int a = metadata.schema.find(name);
            auto value = static_cast<std::uint16_t>(result.points.value<std::uint16_t>(a, i) % 240);
            result.points.setValue<std::uint16_t>(a, i, value);
            result.shown.push_back(static_cast<std::uint16_t>(value + i % 5));
        }
    return result;
}

// A file of one node.
Bytes fileOf(CloudMetadata metadata, const EncodedNode& node) {
    metadata.pointCount = node.pointCount;
    std::string path = temporaryPath("shown");
    auto writer = need(CloudWriter::create(path));
    need(writer->add(node));
    need(writer->finish(metadata));
    auto source = need(openFileSource(path));
    Bytes bytes = need(readNow(*source, {0, source->sizeBytes()}));
    std::filesystem::remove(path);
    return bytes;
}

NodeEntry onlyNode(CloudReader& reader) {
    NodeEntry entry;
    need(reader.visitNodes([&](const NodeEntry& node) -> Status {
        entry = node;
        return {};
    }));
    return entry;
}

// The picture's colours, by position: points lie at random places, no two at one.
std::map<std::array<std::uint32_t, 3>, std::array<std::uint16_t, 3>> colourAt(const NodePicture& picture) {
    std::map<std::array<std::uint32_t, 3>, std::array<std::uint16_t, 3>> result;
    for (std::size_t i = 0; i < picture.size(); ++i)
        result[{picture.positions[i].x, picture.positions[i].y, picture.positions[i].z}] = {
            picture.colour[3 * i], picture.colour[3 * i + 1], picture.colour[3 * i + 2]};
    return result;
}

} // namespace

TEST_CASE("a node shows what it is given to show, and its points keep their colours") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 1000);
    Bytes file = fileOf(metadata, need(encodeNode(metadata, {}, points, shown)));
    MemorySource source(file);
    auto reader = need(CloudReader::open(source));
    CHECK(reader->header().version == 2);
    CHECK(reader->metadata().innerColour == InnerColour::mean);
    NodeEntry entry = onlyNode(*reader);
    CHECK(entry.attributeBytes[0] > 0);
    Bytes strata = need(readNow(source, entry.strataRange(strataCount)));
    auto seen = colourAt(need(decodePicture(metadata, entry, strataCount, strata)));
    REQUIRE(seen.size() == points.size());
    bool asGiven = true;
    for (std::size_t i = 0; i < points.size(); ++i) {
        Vec3i p = points.positions[i] - metadata.rootCube.min;
        std::array<std::uint32_t, 3> at{static_cast<std::uint32_t>(p.x), static_cast<std::uint32_t>(p.y),
                                        static_cast<std::uint32_t>(p.z)};
        asGiven = asGiven && std::equal(seen[at].begin(), seen[at].end(), shown.begin() + 3 * i);
    }
    CHECK(asGiven);
    CHECK(hashOf(metadata, need(reader->readNode(entry))) == hashOf(metadata, points));
}

TEST_CASE("exact colours are read only where a colour is asked for") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 500);
    Bytes file = fileOf(metadata, need(encodeNode(metadata, {}, points, shown)));
    MemorySource source(file);
    auto reader = need(CloudReader::open(source));
    NodeEntry entry = onlyNode(*reader);
    PointBatch all = need(reader->readNode(entry));
    int green = metadata.schema.find(attribute_names::green), other = 3;
    std::vector<int> withColour{other, green}, without{other};
    NodeBytes bytes = need(reader->fetchNode(entry, withColour)),
              fewer = need(reader->fetchNode(entry, without));
    CHECK(bytes.bytes.size() == fewer.bytes.size() + entry.attributeBytes[0]);
    CHECK(need(decodeNode(metadata, bytes)).columns[1] == all.columns[static_cast<std::size_t>(green)]);
    CHECK(need(decodeNode(metadata, fewer)).positions == all.positions);
}

TEST_CASE("some strata of a node have exact colours, too") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 500);
    MemorySource source(fileOf(metadata, need(encodeNode(metadata, {}, points, shown))));
    auto reader = need(CloudReader::open(source));
    NodeEntry entry = onlyNode(*reader);
    const PointBatch all = need(reader->readNode(entry));
    const int green = metadata.schema.find(attribute_names::green);
    for (int strata = 1; strata <= strataCount; ++strata) {
        NodeBytes node{entry, {green}, need(readNow(source, entry.strataRange(strata))), strata};
        const Bytes exact = need(readNow(source, entry.attributeRange(0)));
        node.bytes.insert(node.bytes.end(), exact.begin(), exact.end());
        PointBatch some = need(decodeNode(metadata, node));
        REQUIRE(some.size() == strataPrefixPoints(entry.pointCount, strata));
        bool same = true;
        for (std::size_t i = 0; i < some.size(); ++i)
            same = same && some.positions[i] == all.positions[i] &&
                   some.value<std::uint16_t>(0, i) == all.value<std::uint16_t>(green, i);
        CHECK(same);
    }
}

TEST_CASE("a node that shows its own colours has no block of exact ones") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 300);
    EncodedNode plain = need(encodeNode(metadata, {}, points));
    CHECK(plain.attributes[0].empty());
    for (std::size_t i = 0; i < shown.size(); ++i)
        shown[i] =
            points.value<std::uint16_t>(metadata.schema.find(attribute_names::red) + int(i % 3), i / 3);
    EncodedNode same = need(encodeNode(metadata, {}, points, shown));
    CHECK(same.attributes[0].empty());
    CHECK(same.strata == plain.strata);

    MemorySource source(fileOf(metadata, plain));
    auto reader = need(CloudReader::open(source));
    CHECK(hashOf(metadata, need(reader->readNode(onlyNode(*reader)))) == hashOf(metadata, points));
}

TEST_CASE("colours of 16 bits are shown in 8, and an intensity in all of its own") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 200);
    for (std::size_t i = 0; i < points.size(); ++i)
        points.setValue<std::uint16_t>(metadata.schema.find(attribute_names::red), i,
                                       static_cast<std::uint16_t>(i * 300 + 1));
    for (std::uint16_t& value : shown)
        value = static_cast<std::uint16_t>(value * 250 + 3);
    auto shownBy = [&, &points = points](const CloudMetadata& m, const Values& given) {
        MemorySource source(fileOf(m, need(encodeNode(m, {}, points, given))));
        auto reader = need(CloudReader::open(source));
        NodeEntry entry = onlyNode(*reader);
        CHECK(hashOf(m, need(reader->readNode(entry))) == hashOf(m, points));
        return need(decodePicture(m, entry, strataCount,
                                  need(readNow(source, entry.strataRange(strataCount)))))
            .colour;
    };
    Values rgb = shownBy(metadata, shown);
    CHECK(std::all_of(rgb.begin(), rgb.end(), [](std::uint16_t value) { return value % 257 == 0; }));
    metadata.pictureColour = PictureColour::intensity;
    Values intensity(shown.begin(), shown.begin() + 200), seen = shownBy(metadata, intensity);
    std::sort(intensity.begin(), intensity.end());
    std::sort(seen.begin(), seen.end());
    CHECK(seen == intensity);
}

TEST_CASE("equal points that show different colours give the same bytes in any order") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 64);
    for (std::size_t i = 1; i < 32; ++i) {
        points.positions[i] = points.positions[0];
        for (std::size_t a = 0; a < points.columns.size(); ++a) {
            std::size_t size = metadata.schema.attributes[a].size();
            std::copy_n(points.columns[a].begin(), size,
                        points.columns[a].begin() + static_cast<std::ptrdiff_t>(i * size));
        }
        for (std::size_t c = 0; c < 3; ++c)
            shown[3 * i + c] = static_cast<std::uint16_t>(i * 5 % 31);
    }
    EncodedNode node = need(encodeNode(metadata, {}, points, shown));
    Values reversed = shown;
    for (std::size_t i = 0; i < 32; ++i)
        std::copy_n(shown.begin() + static_cast<std::ptrdiff_t>(3 * (31 - i)), 3,
                    reversed.begin() + static_cast<std::ptrdiff_t>(3 * i));
    EncodedNode other = need(encodeNode(metadata, {}, points, reversed));
    CHECK(node.strata == other.strata);
    CHECK(node.attributes == other.attributes);
}

TEST_CASE("something to show that does not fit the picture is refused") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 10);
    shown.pop_back();
    CHECK(encodeNode(metadata, {}, points, shown).error().code == ErrorCode::invalidArgument);
    shown.push_back(0);
    metadata.innerColour = InnerColour::exact;
    CHECK(encodeNode(metadata, {}, points, shown).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a damaged block of exact colours is an error that names it") {
    CloudMetadata metadata = meanMetadata();
    auto [points, shown] = shownPoints(metadata, {}, 200);
    EncodedNode node = need(encodeNode(metadata, {}, points, shown));
    MemorySource source(fileOf(metadata, node));
    auto reader = need(CloudReader::open(source));
    NodeEntry entry = onlyNode(*reader);
    NodePicture picture = need(
        decodePicture(metadata, entry, strataCount, need(readNow(source, entry.strataRange(strataCount)))));
    forEachDamage(node.attributes[0], 1000, [&](const Bytes& damaged) {
        NodePicture copy = picture;
        if (damaged == node.attributes[0])
            return;
        Status read = decodeExactColour(metadata, entry, damaged, copy);
        REQUIRE(!read.ok());
        if (damaged.size() == node.attributes[0].size())
            CHECK(read.error().sentence().find("node 0-0-0-0, exact colours") == 0);
    });
    CHECK(decodeAttributes(metadata, entry, 0, node.attributes[0]).error().code ==
          ErrorCode::invalidArgument);
    picture.colour.pop_back();
    CHECK(decodeExactColour(metadata, entry, node.attributes[0], picture).error().code ==
          ErrorCode::invalidArgument);
}
