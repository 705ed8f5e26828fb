#include "client/core/node_decoder.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/io/memory_source.hpp"
#include "tests/support/counting_gate.hpp"
#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {

Bytes bytesOf(const SmallCloud& cloud, ByteRange range) {
    auto from = cloud.file.begin() + static_cast<std::ptrdiff_t>(range.offset);
    return Bytes(from, from + static_cast<std::ptrdiff_t>(range.size));
}

// The whole picture of the second node.
DecodeJob pictureJob(const SmallCloud& cloud) {
    DecodeJob job;
    job.metadata = std::make_shared<const CloudMetadata>(cloud.metadata);
    job.entry = cloud.nodes.at(1);
    job.picture = bytesOf(cloud, job.entry.strataRange(strataCount));
    return job;
}

// A further block of it.
DecodeJob blockJob(const SmallCloud& cloud, int block) {
    DecodeJob job = pictureJob(cloud);
    job.picture.clear();
    job.strata = 0;
    job.block = block;
    job.attributes = bytesOf(cloud, job.entry.attributeRange(static_cast<std::size_t>(block)));
    return job;
}

// The second node's points as a reader of whole files has them.
PointBatch pointsOf(const SmallCloud& cloud) {
    MemorySource source(cloud.file);
    auto reader = CloudReader::open(source);
    REQUIRE(reader.ok());
    auto points = (*reader)->readNode(cloud.nodes.at(1));
    REQUIRE(points.ok());
    return std::move(*points);
}

// That the error begins with the node's name and says it once.
void checkPlacedOnce(const DecodeJob& job) {
    Result<ResidentNode> node = decodeNode(job);
    REQUIRE_FALSE(node.ok());
    std::string sentence = node.error().sentence(), name = "node " + job.entry.key.text();
    INFO(sentence);
    CHECK(sentence.find(name) == 0);
    CHECK(sentence.rfind(name) == 0);
}

} // namespace

TEST_CASE("decoding ends within a piece of the node once nobody wants it") {
    DecodeJob job = pictureJob(makeSmallCloud({.levels = 2, .pointsPerNode = 3 * WorkGate::pieceItems}));
    CountingGate open;
    REQUIRE(decodeNode(job, &open).ok());
    CHECK(open.largest() <= WorkGate::pieceItems);
    CHECK(open.handled() >= 5 * std::uint64_t{job.entry.pointCount});
    for (int step = 0; step < 20; ++step) {
        CountingGate gate(open.handled() * static_cast<std::uint64_t>(step) / 20);
        Result<ResidentNode> node = decodeNode(job, &gate);
        REQUIRE_FALSE(node.ok());
        CHECK(node.error().code == ErrorCode::cancelled);
        CHECK(gate.refused() == 1);
    }
}

TEST_CASE("an error of a node names the node once") {
    SmallCloud cloud = makeSmallCloud();
    DecodeJob whole = pictureJob(cloud);
    REQUIRE(decodeNode(whole).ok());
    REQUIRE(decodeNode(blockJob(cloud, 0)).ok());

    DecodeJob altered = whole;
    altered.picture[altered.picture.size() / 2] ^= 1;
    checkPlacedOnce(altered);

    DecodeJob cut = whole;
    cut.picture.resize(cut.picture.size() - 1);
    checkPlacedOnce(cut);

    DecodeJob alteredBlock = blockJob(cloud, 0);
    alteredBlock.attributes.back() ^= 1;
    checkPlacedOnce(alteredBlock);

    for (int block : {-1, 99}) {
        DecodeJob noBlock = blockJob(cloud, 0);
        noBlock.block = block;
        checkPlacedOnce(noBlock);
    }

    DecodeJob tooDeep = whole;
    tooDeep.entry.key.level = 30;
    checkPlacedOnce(tooDeep);

    DecodeJob noStrata = whole;
    noStrata.strata = strataCount + 1;
    checkPlacedOnce(noStrata);

    DecodeJob noMetadata = whole;
    noMetadata.metadata.reset();
    checkPlacedOnce(noMetadata);
}

TEST_CASE("what an inner node shows is drawn, whatever its points' own colours are") {
    SmallCloud cloud = makeSmallCloud({.innerColour = InnerColour::mean});
    DecodeJob job = pictureJob(cloud);
    REQUIRE(job.entry.attributeBytes[0] > 0); // the exact colours, which are asked for by themselves
    ResidentNode node = *decodeNode(job);
    NodePicture picture = *decodePicture(cloud.metadata, job.entry, strataCount, job.picture);
    REQUIRE(node.colourWords.size() == picture.size());
    bool asShown = true;
    for (std::size_t i = 0; i < picture.size(); ++i)
        asShown = asShown && (node.colourWords[i] & 255) == picture.colour[3 * i] >> 8u;
    CHECK(asShown);
}

TEST_CASE("a block of attributes becomes columns of all the node's points, bit for bit") {
    SmallCloud cloud = makeSmallCloud();
    PointBatch points = pointsOf(cloud);
    for (int block : {0, 1}) { // Intensity, Point Source ID
        ResidentNode node = *decodeNode(blockJob(cloud, block));
        CHECK(node.positionWords.empty());
        REQUIRE(node.columns.columns.size() == 1);
        CHECK(node.columns.pointCount == points.size());
        ByteSpan column = node.columns.column(block);
        CHECK(Bytes(column.begin(), column.end()) == points.columns[static_cast<std::size_t>(block)]);
        CHECK(node.columns.column(block + 7).empty());
    }
}

TEST_CASE("exact colours come from what is shown and their block") {
    SmallCloud cloud = makeSmallCloud({.innerColour = InnerColour::mean});
    ResidentNode shown = *decodeNode(pictureJob(cloud));
    DecodeJob job = blockJob(cloud, 0);
    job.shown = shownColours(shown);
    ResidentNode exact = *decodeNode(job);
    PointBatch points = pointsOf(cloud);
    ByteSpan words = exact.columns.column(exactColourWords);
    REQUIRE(words.size() == 4 * points.size());
    int red = cloud.metadata.schema.find(attribute_names::red);
    std::size_t different = 0, wrong = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        std::uint32_t word = loadLe<std::uint32_t>(words.data() + 4 * i);
        std::uint32_t expected = 0xFF000000u;
        for (int c = 0; c < 3; ++c)
            expected |= static_cast<std::uint32_t>(points.value<std::uint16_t>(red + c, i) >> 8) << (8 * c);
        wrong += word != expected;
        different += word != shown.colourWords[i];
    }
    CHECK(wrong == 0);
    CHECK(different > points.size() / 2);

    job.shown.pop_back();
    checkPlacedOnce(job);
}

TEST_CASE("exact intensities come from what is shown and their block") {
    SmallCloud cloud = makeSmallCloud({.colour = PictureColour::intensity, .innerColour = InnerColour::mean});
    DecodeJob job = blockJob(cloud, 0);
    job.shown = shownColours(*decodeNode(pictureJob(cloud)));
    ResidentNode exact = *decodeNode(job);
    PointBatch points = pointsOf(cloud);
    ByteSpan values = exact.columns.column(exactIntensity);
    int intensity = cloud.metadata.schema.find(attribute_names::intensity);
    CHECK(Bytes(values.begin(), values.end()) == points.columns[static_cast<std::size_t>(intensity)]);
    CHECK(job.shown != points.columns[static_cast<std::size_t>(intensity)]);
}
