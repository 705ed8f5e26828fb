#include "client/core/node_decoder.hpp"

#include "shared/format/cloud_file.hpp"
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

// Everything of the second node.
DecodeJob wholeJob(const SmallCloud& cloud) {
    DecodeJob job;
    job.metadata = std::make_shared<const CloudMetadata>(cloud.metadata);
    job.entry = cloud.nodes.at(1);
    job.picture = bytesOf(cloud, job.entry.strataRange(strataCount));
    job.wantsIntensity = true;
    auto block = static_cast<std::size_t>(intensityBlock(cloud.metadata));
    job.intensity = bytesOf(cloud, job.entry.attributeRange(block));
    return job;
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
    DecodeJob job = wholeJob(makeSmallCloud({.levels = 2, .pointsPerNode = 3 * WorkGate::pieceItems}));
    CountingGate open;
    REQUIRE(decodeNode(job, &open).ok());
    CHECK(open.largest() <= WorkGate::pieceItems);
    CHECK(open.handled() >= 6 * std::uint64_t{job.entry.pointCount});
    for (int step = 0; step < 20; ++step) {
        CountingGate gate(open.handled() * static_cast<std::uint64_t>(step) / 20);
        Result<ResidentNode> node = decodeNode(job, &gate);
        REQUIRE_FALSE(node.ok());
        CHECK(node.error().code == ErrorCode::cancelled);
        CHECK(gate.refused() == 1);
    }
}

TEST_CASE("an error of a node names the node once") {
    DecodeJob whole = wholeJob(makeSmallCloud());
    REQUIRE(decodeNode(whole).ok());

    DecodeJob altered = whole;
    altered.picture[altered.picture.size() / 2] ^= 1;
    checkPlacedOnce(altered);

    DecodeJob cut = whole;
    cut.picture.resize(cut.picture.size() - 1);
    checkPlacedOnce(cut);

    DecodeJob alteredIntensity = whole;
    alteredIntensity.intensity.back() ^= 1;
    checkPlacedOnce(alteredIntensity);

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
    DecodeJob job = wholeJob(cloud);
    REQUIRE(job.entry.attributeBytes[0] > 0); // the exact colours, which nobody asks for
    ResidentNode node = *decodeNode(job);
    NodePicture picture = *decodePicture(cloud.metadata, job.entry, strataCount, job.picture);
    REQUIRE(node.colourWords.size() == picture.size());
    bool asShown = true;
    for (std::size_t i = 0; i < picture.size(); ++i)
        asShown = asShown && (node.colourWords[i] & 255) == picture.colour[3 * i] >> 8u;
    CHECK(asShown);

    SmallCloud exact = makeSmallCloud();
    CHECK(intensityBlock(cloud.metadata) == intensityBlock(exact.metadata) + 1);
    SmallCloud intensity =
        makeSmallCloud({.colour = PictureColour::intensity, .innerColour = InnerColour::mean});
    CHECK(intensityBlock(intensity.metadata) < 0);
}

TEST_CASE("intensities that the cloud does not have are an error of the node") {
    SmallCloudOptions options;
    options.withIntensity = false;
    SmallCloud cloud = makeSmallCloud(options);
    REQUIRE(intensityBlock(cloud.metadata) < 0);
    DecodeJob job;
    job.metadata = std::make_shared<const CloudMetadata>(cloud.metadata);
    job.entry = cloud.nodes.at(1);
    job.strata = 0;
    job.wantsIntensity = true;
    job.intensity = Bytes(10);
    checkPlacedOnce(job);
}
