#include "shared/codec/bit_stream.hpp"
#include "shared/codec/checksum.hpp"
#include "shared/codec/radix_sort.hpp"
#include "shared/codec/varint.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace stipple;

namespace {
std::uint64_t hashOf(std::string_view text) {
    return xxh64(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}
} // namespace

TEST_CASE("checksums are those of the XXH64 specification") {
    CHECK(hashOf("") == 0xEF46DB3751D8E999ull);
    CHECK(hashOf("a") == 0xD24EC4F1A98C6E5Bull);
    CHECK(hashOf("abc") == 0x44BC2CF5AD770999ull);
    CHECK(hashOf("Nobody inspects the spammish repetition") == 0xFBCEA83C8A378BF1ull);
}

TEST_CASE("varints of every length come back") {
    ByteWriter to;
    std::vector<std::uint64_t> values{0, 1, 127, 128, 16383, 16384, UINT32_MAX, UINT64_MAX};
    for (std::uint64_t value : values)
        writeVarint(to, value);
    ByteReader from(to.bytes());
    for (std::uint64_t value : values)
        CHECK(readVarint(from) == value);
    CHECK(from.ok());
    CHECK(from.remaining() == 0);
    readVarint(from);
    CHECK(!from.ok());
}

TEST_CASE("a varint without an end stops after ten bytes") {
    Bytes endless(64, 0xFF);
    ByteReader from(endless);
    readVarint(from);
    CHECK(from.position() == 10);
}

TEST_CASE("signed numbers are mapped with small ones first") {
    CHECK(zigzag(0) == 0);
    CHECK(zigzag(-1) == 1);
    CHECK(zigzag(1) == 2);
    for (std::int64_t value : {INT64_MIN, std::int64_t{-77}, std::int64_t{0}, INT64_MAX})
        CHECK(unzigzag(zigzag(value)) == value);
}

TEST_CASE("bits of every width come back, and reading past the end is noticed") {
    std::mt19937_64 random(3);
    std::vector<std::pair<std::uint64_t, int>> values;
    BitWriter to;
    for (int i = 0; i < 5000; ++i) {
        int count = static_cast<int>(random() % 64);
        std::uint64_t value = random() & ((std::uint64_t{1} << count) - 1);
        values.emplace_back(value, count);
        to.write(value, count);
    }
    PaddedBytes stream(to.take());
    BitReader from(stream);
    bool equal = true;
    for (auto [value, count] : values)
        equal = equal && from.read(count) == value;
    CHECK(equal);
    CHECK(from.ok());
    from.read(8);
    CHECK(!from.ok());
}

TEST_CASE("sorting by key is stable and ascending, for keys that differ in any bits") {
    std::mt19937_64 random(3);
    for (int bits : {1, 11, 20, 33, 52, 63})
        for (std::uint32_t count : {0u, 1u, 2u, 100u, 10000u}) {
            std::vector<KeyedIndex> items;
            for (std::uint32_t i = 0; i < count; ++i) {
                // A third spread over all bits, a third alike in the upper ones, a third in the lower.
                std::uint64_t key = i % 3 == 0 ? random() : i % 3 == 1 ? random() % 300 : random() % 30 << 40;
                items.push_back({key & ((std::uint64_t{1} << bits) - 1), i});
            }
            auto expected = items;
            std::stable_sort(expected.begin(), expected.end(),
                             [](auto& a, auto& b) { return a.key < b.key; });
            sortByKey(items, bits);
            CHECK(std::equal(items.begin(), items.end(), expected.begin(), expected.end(),
                             [](auto& a, auto& b) { return a.key == b.key && a.index == b.index; }));
        }
}
