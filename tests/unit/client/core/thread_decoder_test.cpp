#include "client/headless/thread_decoder.hpp"

#include "tests/support/small_cloud.hpp"

#include <catch2/catch.hpp>

#include <map>

using namespace stipple;
using namespace stipple::test;

namespace {

std::vector<DecodeJob> jobsOf(const SmallCloud& cloud) {
    auto metadata = std::make_shared<const CloudMetadata>(cloud.metadata);
    std::vector<DecodeJob> jobs;
    for (const NodeEntry& entry : cloud.nodes) {
        ByteRange range = entry.strataRange(strataCount);
        auto from = cloud.file.begin() + static_cast<std::ptrdiff_t>(range.offset);
        DecodeJob job;
        job.metadata = metadata;
        job.entry = entry;
        job.picture = Bytes(from, from + static_cast<std::ptrdiff_t>(range.size));
        jobs.push_back(std::move(job));
    }
    return jobs;
}

} // namespace

TEST_CASE("threads decode what one thread decodes, and answer once, inside pump") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 2000});
    auto decoder = makeThreadDecoder(4);
    std::map<NodeKey, std::vector<std::uint32_t>> words;
    int answers = 0;
    for (DecodeJob& job : jobsOf(cloud))
        decoder->decode(std::move(job), [&](Result<ResidentNode> node) {
            REQUIRE(node.ok());
            words[node->key] = node->positionWords;
            ++answers;
        });
    CHECK(answers == 0);
    int delivered = 0;
    while (decoder->pending() > 0)
        delivered += decoder->pump(std::chrono::milliseconds(1000));
    CHECK(answers == static_cast<int>(cloud.nodes.size()));
    CHECK(delivered == answers);
    for (const DecodeJob& job : jobsOf(cloud)) {
        Result<ResidentNode> node = decodeNode(job);
        REQUIRE(node.ok());
        CHECK(words[node->key] == node->positionWords);
    }
    CHECK(decoder->pump(std::chrono::milliseconds(0)) == 0);
}

TEST_CASE("a decoder that is closed answers what it did not deliver") {
    SmallCloud cloud = makeSmallCloud({.levels = 3, .pointsPerNode = 2000});
    std::size_t answered = 0;
    {
        auto decoder = makeThreadDecoder(2);
        for (DecodeJob& job : jobsOf(cloud))
            decoder->decode(std::move(job), [&](Result<ResidentNode> node) {
                CHECK_FALSE(node.ok());
                CHECK(node.error().code == ErrorCode::cancelled);
                ++answered;
            });
    }
    CHECK(answered == cloud.nodes.size());
}
