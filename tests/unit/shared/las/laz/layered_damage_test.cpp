#include "tests/support/byte_values.hpp"
#include "tests/support/mutate.hpp"
#include "tests/unit/shared/las/laz/layered_points.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;
using namespace stipple::las::laz;

namespace {

constexpr std::size_t points = 900;

Bytes chunkOf(const LayeredCase& of) {
    return encodeLayered(of, scannedRecords(of, points, 21, 4));
}

} // namespace

TEST_CASE("every truncation of a layered chunk is reported") {
    for (LayeredCase of : {LayeredCase{6, 0, 3}, LayeredCase{10, 2, 4}}) {
        Bytes chunk = chunkOf(of);
        for (std::size_t size = 0; size < chunk.size(); ++size) {
            auto decoded = decodeLayered(of, ByteSpan(chunk).first(size), points);
            REQUIRE_FALSE(decoded.ok());
            REQUIRE(decoded.error().code == ErrorCode::truncated);
        }
    }
}

TEST_CASE("a layer that ends early is reported") {
    LayeredCase of{10, 2, 3};
    Bytes chunk = chunkOf(of);
    const std::size_t sizesAt = recordLengthOf(itemsOf(of)) + 4;
    std::size_t layerAt = sizesAt + 4 * 14;
    for (std::size_t layer = 0; layer < 14; ++layer) {
        const auto size = loadLe<std::uint32_t>(chunk.data() + sizesAt + 4 * layer);
        if (size > 40) {
            // Its second half is taken out.
            Bytes shorter = chunk;
            auto from = shorter.begin() + static_cast<std::ptrdiff_t>(layerAt + size / 2);
            shorter.erase(from, from + (size - size / 2));
            storeLe(shorter.data() + sizesAt + 4 * layer, size / 2);
            auto decoded = decodeLayered(of, shorter, points);
            INFO("layer " << layer);
            REQUIRE_FALSE(decoded.ok());
            CHECK(decoded.error().code == ErrorCode::corrupt);
        }
        layerAt += size;
    }
}

TEST_CASE("a chunk of fewer points than expected is reported, one of more is decoded in part") {
    LayeredCase of{7, 0, 3};
    Bytes records = scannedRecords(of, points, 21, 4), chunk = chunkOf(of);
    auto more = decodeLayered(of, chunk, points + 1);
    REQUIRE_FALSE(more.ok());
    CHECK(more.error().what == "the chunk says that it has 900 points, the file 901");
    auto fewer = decodeLayered(of, chunk, 100);
    REQUIRE(fewer.ok());
    CHECK(*fewer == Bytes(records.begin(), records.begin() + 100 * 36));
}

TEST_CASE("damaged layered chunks neither crash nor hang") {
    for (LayeredCase of : {LayeredCase{6, 0, 3}, LayeredCase{7, 4, 4}, LayeredCase{10, 2, 3}}) {
        Bytes chunk = chunkOf(of);
        int refused = 0;
        for (std::uint64_t seed = 0; seed < damages(1500); ++seed) {
            auto decoded = decodeLayered(of, mutate(chunk, seed).bytes, points);
            refused += !decoded.ok();
            if (!decoded.ok())
                REQUIRE_FALSE(decoded.error().what.empty());
        }
        CHECK(refused > damages(300)); // the others are other points
    }
}

TEST_CASE("each byte of a layered chunk's head may be anything") {
    LayeredCase of{8, 1, 3};
    Bytes chunk = chunkOf(of);
    const std::size_t head = recordLengthOf(itemsOf(of)) + 4 + 4 * 12;
    for (std::size_t at = 0; at < head; ++at)
        for (int value : {0, 1, 127, 128, 255}) {
            Bytes damaged = chunk;
            damaged[at] = static_cast<std::uint8_t>(value);
            auto decoded = decodeLayered(of, damaged, points);
            if (!decoded.ok())
                REQUIRE_FALSE(decoded.error().what.empty());
        }
}

TEST_CASE("layers of noise neither crash nor hang") {
    LayeredCase of{10, 3, 3};
    Bytes noise = randomRecords({6, 0, 3}, 3000, 1);
    Bytes chunk = scannedRecords(of, 1, 1, 1);
    ByteWriter head;
    head.write(std::uint32_t{points});
    for (int i = 0; i < 15; ++i)
        head.write(std::uint32_t{6000});
    chunk.insert(chunk.end(), head.bytes().begin(), head.bytes().end());
    for (unsigned fill : {0u, 1u, 128u, 255u}) {
        Bytes filled = chunk;
        filled.resize(chunk.size() + 15 * 6000, static_cast<std::uint8_t>(fill));
        auto decoded = decodeLayered(of, filled, points);
        if (!decoded.ok())
            CHECK(decoded.error().code == ErrorCode::corrupt);
    }
    Bytes noisy = chunk;
    noisy.insert(noisy.end(), noise.begin(), noise.begin() + 15 * 6000);
    auto decoded = decodeLayered(of, noisy, points);
    if (!decoded.ok())
        CHECK(decoded.error().code == ErrorCode::corrupt);
}
