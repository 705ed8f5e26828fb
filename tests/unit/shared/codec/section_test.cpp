#include "shared/codec/integer_planes.hpp"
#include "shared/codec/section.hpp"
#include "tests/unit/shared/codec/damage.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;

namespace {
Bytes skewed(std::size_t size) {
    std::mt19937 random(1);
    Bytes bytes(size);
    for (auto& byte : bytes)
        byte = static_cast<std::uint8_t>(random() % (1 + random() % 20));
    return bytes;
}
} // namespace

TEST_CASE("sections come back at every effort") {
    for (Effort effort : {Effort::literals, Effort::fast, Effort::thorough})
        for (std::size_t size : {0, 1, 5, 300, 200000}) {
            Bytes content = skewed(size);
            ByteWriter to;
            writeSection(to, content, effort);
            ByteReader from(to.bytes());
            Bytes read(size);
            CHECK(readFullSection(from, read).ok());
            CHECK(read == content);
            CHECK(from.remaining() == 0);
        }
}

TEST_CASE("literals are compressed, noise is stored") {
    ByteWriter compressed, stored;
    writeSection(compressed, skewed(10000), Effort::literals);
    CHECK(compressed.size() < 6000);
    Bytes noise(1000);
    std::mt19937 random(1);
    for (auto& byte : noise)
        byte = static_cast<std::uint8_t>(random());
    writeSection(stored, noise, Effort::literals);
    CHECK(stored.size() == 1002);
}

TEST_CASE("a section never fills more than its room") {
    ByteWriter to;
    writeSection(to, Bytes(100000), Effort::thorough); // a few bytes that claim many
    Bytes room(99999);
    ByteReader from(to.bytes());
    auto size = readSection(from, room);
    REQUIRE(!size.ok());
    CHECK(size.error().code == ErrorCode::corrupt);
}

TEST_CASE("damaged sections are errors or other bytes") {
    ByteWriter to;
    writeSection(to, skewed(2000), Effort::literals);
    forEachDamage(to.bytes(), 2000, [&](const Bytes& damaged) {
        Bytes room(2000);
        ByteReader from(damaged);
        auto size = readSection(from, room);
        CHECK((!size.ok() || *size <= room.size()));
    });
}

TEST_CASE("planes of every width come back") {
    std::mt19937_64 random(9);
    std::vector<std::uint64_t> walk{UINT64_MAX, 0, UINT64_MAX / 2 + 1, 5};
    for (int i = 0; i < 2000; ++i)
        walk.push_back(walk.back() + random() % 1000 - 500);
    auto check = [&]<class T>(T) {
        std::vector<T> values(walk.begin(), walk.end()), read(values.size());
        ByteWriter to;
        writePlanes<T>(to, values);
        ByteReader from(to.bytes());
        CHECK(readPlanes<T>(from, read).ok());
        CHECK(read == values);
    };
    check(std::uint8_t{});
    check(std::uint16_t{});
    check(std::uint32_t{});
    check(std::uint64_t{});
}
