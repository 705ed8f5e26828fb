#include "client/region/piece_sink.hpp"

#include "tests/support/byte_values.hpp"

#include <catch2/catch.hpp>

#include <random>

using namespace stipple;
using stipple::test::countingBytes;

TEST_CASE("pieces and patches together are the file that memory would have") {
    std::mt19937 random(3);
    for (int round = 0; round < 50; ++round) {
        auto pieces = std::make_shared<Pieces>();
        PieceSink sink(pieces);
        Bytes expected, taken;
        MemorySink memory(expected);
        for (int step = 0; step < 40; ++step) {
            Bytes bytes = countingBytes(random(), random() % 50);
            if (random() % 3 == 0 && expected.size() > bytes.size()) {
                std::uint64_t at = random() % (expected.size() - bytes.size());
                REQUIRE(memory.overwrite(at, bytes).ok());
                REQUIRE(sink.overwrite(at, bytes).ok());
            } else {
                REQUIRE(memory.append(bytes).ok());
                REQUIRE(sink.append(bytes).ok());
            }
            if (random() % 4 == 0) {
                Bytes piece = pieces->take();
                taken.insert(taken.end(), piece.begin(), piece.end());
            }
        }
        Bytes piece = pieces->take();
        taken.insert(taken.end(), piece.begin(), piece.end());
        for (const auto& [offset, bytes] : pieces->patches)
            std::copy(bytes.begin(), bytes.end(), taken.begin() + static_cast<std::ptrdiff_t>(offset));
        CHECK(taken == expected);
        CHECK(sink.sizeBytes() == expected.size());
    }
}

TEST_CASE("bytes that were never there can't be written over") {
    auto pieces = std::make_shared<Pieces>();
    PieceSink sink(pieces);
    REQUIRE(sink.append(countingBytes(0, 10)).ok());
    pieces->take();
    CHECK(sink.overwrite(0, countingBytes(1, 10)).ok());
    CHECK_FALSE(sink.overwrite(0, countingBytes(1, 11)).ok());
    CHECK_FALSE(sink.overwrite(~0ull, countingBytes(1, 2)).ok());
}
