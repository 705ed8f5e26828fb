#include "client/web/decode_messages.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

DecodeJob sampleJob() {
    DecodeJob job;
    job.cloud = 7;
    job.entry.key = {5, 1, 2, 31};
    job.entry.childMask = 0xA5;
    job.entry.pointCount = 12345;
    job.entry.offsetBytes = 1ull << 40;
    job.entry.strataBytes = {10, 20, 30, 40};
    job.entry.attributeBytes = {1, 2, 3};
    job.strata = 2;
    job.block = 3;
    return job;
}

ResidentNode sampleNode() {
    ResidentNode node;
    node.key = {3, 1, 2, 4};
    node.nodeBits = 24;
    node.positionShift = 3;
    node.pointCount = 2;
    node.totalPoints = 9;
    node.shownUnit = 257;
    node.positionWords = {1, 2, 3, 4};
    node.positionLowWords = {5, 6};
    node.colourWords = {7, 8};
    node.columns = {2, {{pictureIntensity, 2}}, {1, 2, 3, 4}};
    return node;
}

} // namespace

TEST_CASE("a decoding job arrives as it was sent") {
    DecodeJob job = sampleJob();
    auto back = web::decodeJob(web::encodeJob(job));
    REQUIRE(back.ok());
    CHECK(back->cloud == 7);
    CHECK(back->entry.key == job.entry.key);
    CHECK(back->entry.childMask == 0xA5);
    CHECK(back->entry.pointCount == 12345);
    CHECK(back->entry.offsetBytes == 1ull << 40);
    CHECK(back->entry.strataBytes == job.entry.strataBytes);
    CHECK(back->entry.attributeBytes == job.entry.attributeBytes);
    CHECK(back->strata == 2);
    CHECK(back->block == 3);
    CHECK(back->points.empty());
    job.points = {4, 0, 12344};
    auto points = web::decodeJob(web::encodeJob(job));
    REQUIRE(points.ok());
    CHECK(points->points == job.points);
}

TEST_CASE("an answer brings a node whose arrays have their sizes") {
    ResidentNode node = sampleNode();
    auto back = web::decodeAnswer(web::encodeAnswer(node));
    REQUIRE(back.ok());
    CHECK(back->key == node.key);
    CHECK(back->nodeBits == 24);
    CHECK(back->positionShift == 3);
    CHECK(back->totalPoints == 9);
    CHECK(back->shownUnit == 257);
    for (int i = 0; i < web::nodeArrayCount; ++i) {
        ByteSpan from = web::nodeArray(node, i);
        REQUIRE(web::nodeArray(*back, i).size() == from.size());
        std::copy(from.begin(), from.end(), web::nodeArrayBytes(*back, i));
    }
    CHECK(back->positionWords == node.positionWords);
    CHECK(back->positionLowWords == node.positionLowWords);
    CHECK(back->colourWords == node.colourWords);
    CHECK(back->columns == node.columns);
}

TEST_CASE("attributes alone travel without positions") {
    DecodeJob job = sampleJob();
    job.strata = 0;
    CHECK(web::decodeJob(web::encodeJob(job)).ok());
    ResidentNode node;
    node.pointCount = node.totalPoints = 3;
    node.columns = {3, {{4, 1}, {5, 8}}, Bytes(27)};
    auto back = web::decodeAnswer(web::encodeAnswer(node));
    REQUIRE(back.ok());
    CHECK(back->positionWords.empty());
    CHECK(back->columns == node.columns);
}

TEST_CASE("an array that is neither whole nor absent is refused") {
    ResidentNode node = sampleNode();
    node.colourWords.push_back(9);
    CHECK_FALSE(web::decodeAnswer(web::encodeAnswer(node)).ok());
}

TEST_CASE("an error keeps its code and its words") {
    Error error{ErrorCode::corrupt, "the checksum is wrong", "town.stipple, byte 4096", "convert it again"};
    auto back = web::decodeAnswer(web::encodeAnswer(error));
    REQUIRE_FALSE(back.ok());
    CHECK(back.error().code == ErrorCode::corrupt);
    CHECK(back.error().sentence() == error.sentence());
}

TEST_CASE("every cut or lengthened message is refused") {
    for (Bytes whole : {web::encodeJob(sampleJob()), web::encodeAnswer(sampleNode())}) {
        bool isJob = whole == web::encodeJob(sampleJob());
        auto isRefused = [&](const Bytes& message) {
            return isJob ? !web::decodeJob(message).ok() : !web::decodeAnswer(message).ok();
        };
        for (std::size_t size = 0; size < whole.size(); ++size)
            CHECK(isRefused(Bytes(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size))));
        whole.push_back(0);
        CHECK(isRefused(whole));
    }
}
