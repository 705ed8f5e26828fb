#include "client/core/byte_ranges.hpp"
#include "client/core/kept_bytes.hpp"
#include "tests/support/byte_values.hpp"

#include <catch2/catch.hpp>

#include <random>
#include <set>

using namespace stipple;
using stipple::test::countingBytes;

TEST_CASE("kept bytes are found from where a range begins, over parts that touch") {
    KeptBytes kept;
    kept.add(1, 100, countingBytes(100, 50));
    kept.add(1, 150, countingBytes(150, 10));
    kept.add(1, 200, countingBytes(200, 10));
    kept.add(2, 160, countingBytes(0, 40));
    CHECK(kept.sizeBytes() == 110);
    CHECK(kept.headBytes(1, {100, 200}) == 60);
    CHECK(kept.headBytes(1, {120, 20}) == 20);
    CHECK(kept.headBytes(1, {99, 20}) == 0);
    CHECK(kept.headBytes(1, {160, 5}) == 0);
    CHECK(kept.headBytes(3, {100, 5}) == 0);
    Bytes bytes = countingBytes(110, 5);
    kept.append(1, {115, 42}, bytes);
    CHECK(bytes == countingBytes(110, 47));
}

TEST_CASE("the oldest kept bytes go first, and those of a cloud with it") {
    KeptBytes kept;
    for (std::uint64_t i = 0; i < 10; ++i)
        kept.add(i % 2 ? 1 : 2, i * 100, Bytes(100));
    kept.limit(450);
    CHECK(kept.sizeBytes() == 400);
    CHECK(kept.headBytes(2, {400, 100}) == 0);
    CHECK(kept.headBytes(2, {600, 100}) == 100);
    kept.eraseCloud(2);
    CHECK(kept.sizeBytes() == 200);
    kept.limit(0);
    CHECK(kept.sizeBytes() == 0);
}

TEST_CASE("kept bytes that were used lately stay, the others go first") {
    KeptBytes kept;
    for (std::uint64_t i = 0; i < 4; ++i)
        kept.add(1, i * 100, countingBytes(i * 100, 100));
    Bytes used;
    kept.append(1, {20, 10}, used);
    kept.limit(200);
    CHECK(kept.headBytes(1, {0, 100}) == 100);
    CHECK(kept.headBytes(1, {100, 100}) == 0);
    CHECK(kept.headBytes(1, {200, 100}) == 0);
    CHECK(kept.headBytes(1, {300, 100}) == 100);
}

TEST_CASE("what is kept again takes no more room, and a longer part the place of shorter ones") {
    KeptBytes kept;
    kept.add(1, 100, countingBytes(100, 50));
    kept.add(1, 110, countingBytes(110, 20));
    CHECK(kept.sizeBytes() == 50);
    kept.add(1, 170, countingBytes(170, 10));
    kept.add(1, 100, countingBytes(100, 90));
    CHECK(kept.sizeBytes() == 90);
    CHECK(kept.headBytes(1, {100, 200}) == 90);
    kept.add(1, 150, countingBytes(150, 100)); // over the end of one
    CHECK(kept.headBytes(1, {100, 200}) == 150);
    Bytes bytes;
    kept.append(1, {100, 150}, bytes);
    CHECK(bytes == countingBytes(100, 150));
    kept.erase(1, {245, 3}); // damaged
    CHECK(kept.headBytes(1, {100, 200}) == 90);
    CHECK(kept.headBytes(1, {200, 10}) == 0);
    CHECK(kept.sizeBytes() == 90);
}

TEST_CASE("kept bytes are what they were, in whatever order they come and go") {
    std::mt19937 random(5);
    KeptBytes kept;
    for (int i = 0; i < 3000; ++i) {
        std::uint64_t offset = random() % 600;
        switch (random() % 4) {
        case 0:
            kept.limit(random() % 800);
            break;
        case 1:
            kept.erase(1, {offset, random() % 20});
            break;
        default:
            kept.add(1, offset, countingBytes(offset, random() % 90));
        }
        ByteRange asked{random() % 600, random() % 200};
        asked.size = kept.headBytes(1, asked);
        Bytes bytes;
        kept.append(1, asked, bytes);
        REQUIRE(bytes == countingBytes(asked.offset, static_cast<std::size_t>(asked.size)));
    }
    kept.limit(0);
    CHECK(kept.sizeBytes() == 0);
}

TEST_CASE("a set of ranges counts what it is given twice, as a set of bytes does") {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        ByteRanges ranges;
        std::set<std::uint64_t> bytes;
        for (int i = 0; i < 40; ++i) {
            ByteRange range{random() % 500, random() % 60};
            std::uint64_t common = 0;
            for (std::uint64_t at = range.offset; at < range.end(); ++at)
                common += !bytes.insert(at).second;
            CHECK(ranges.add(range) == common);
        }
    }
}
