#include "tests/unit/shared/las/laz/layered_points.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;
using namespace stipple::las::laz;

namespace {

// Where the records differ first, in words; empty if nowhere.
std::string firstDifference(const Bytes& found, const Bytes& wanted, std::size_t recordLength) {
    if (found.size() != wanted.size())
        return std::to_string(found.size()) + " bytes, not " + std::to_string(wanted.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        if (found[i] != wanted[i])
            return "point " + std::to_string(i / recordLength) + ", byte " + std::to_string(i % recordLength);
    return "";
}

void checkRoundTrip(const LayeredCase& of, const Bytes& records, std::size_t piece = 1000) {
    const std::size_t length = recordLengthOf(itemsOf(of));
    INFO("format " << of.pointFormat << ", " << of.extraBytes << " extra bytes, version " << of.version
                   << ", " << records.size() / length << " points in pieces of " << piece);
    Bytes chunk = encodeLayered(of, records, piece);
    auto decoded = decodeLayered(of, chunk, records.size() / length, {}, piece);
    REQUIRE(decoded.ok());
    CHECK(firstDifference(*decoded, records, length) == "");
}

std::vector<LayeredCase> allCases() {
    std::vector<LayeredCase> cases;
    for (int format = 6; format <= 10; ++format)
        for (std::uint16_t version : {std::uint16_t{3}, std::uint16_t{4}})
            for (std::size_t extraBytes : {0u, 1u, 5u})
                cases.push_back({format, extraBytes, version});
    return cases;
}

} // namespace

TEST_CASE("random layered points come back as they were") {
    for (const LayeredCase& of : allCases())
        checkRoundTrip(of, randomRecords(of, 1500, 3));
}

TEST_CASE("scanned layered points come back as they were, for one to four scanner channels") {
    for (const LayeredCase& of : allCases())
        for (unsigned channels = 1; channels <= 4; ++channels)
            checkRoundTrip(of, scannedRecords(of, 3000, channels, channels));
}

TEST_CASE("a scanner channel other than 0 all through comes back") {
    for (LayeredCase of : allCases()) {
        Bytes records = scannedRecords(of, 700, 5, 1);
        for (std::size_t at = 15; at < records.size(); at += recordLengthOf(itemsOf(of)))
            records[at] = static_cast<std::uint8_t>(records[at] | 0x20);
        checkRoundTrip(of, records);
    }
}

TEST_CASE("all pairs of return number and number of returns, after all others, come back") {
    LayeredCase of{6, 0, 3};
    Bytes records = scannedRecords(of, 65536, 8, 2);
    for (std::size_t i = 0; i < 65536; ++i)
        records[i * 30 + 14] = static_cast<std::uint8_t>(i & 1 ? i >> 8 : i >> 1 & 255);
    checkRoundTrip(of, records);
}

TEST_CASE("GPS times by every multiple of a step, NaNs and both zeros come back") {
    LayeredCase of{6, 0, 3};
    Bytes records = scannedRecords(of, 8000, 9, 2);
    std::mt19937 random(4);
    std::uint64_t time = bitCast<std::uint64_t>(2e8);
    for (std::size_t i = 0; i < 8000; ++i) {
        std::uint64_t written = time;
        if (i < 3000)
            time += 1000 * (i / 5) + random() % 3; // 0 to 600 times
        else if (i < 4000)
            time -= 1000 * (i % 17) + random() % 3;
        else if (i < 5000)
            time += i % 9 == 0 ? 0x100000000ull << i % 20 : 0xFFFFFFFFull / (1 + i % 7);
        else if (i % 3 == 0)
            written = i % 2 ? bitCast<std::uint64_t>(-0.0) : i % 4 ? 0 : 0x7FF8000000000000ull + i % 5;
        storeLe(records.data() + i * 30 + 22, written);
    }
    checkRoundTrip(of, records);
}

TEST_CASE("chunks of any number of points, coded in pieces of any size, come back") {
    for (std::size_t count : {1u, 2u, 511u, 512u, 513u, 514u, 1025u})
        for (std::size_t piece : {1u, 100u, 512u, 2000u}) {
            LayeredCase of{8, 3, 4};
            checkRoundTrip(of, scannedRecords(of, count, 6, 3), piece);
        }
}

TEST_CASE("a coder is used for chunk after chunk") {
    LayeredCase of{10, 2, 3};
    auto encoder = makeLayeredEncoder(itemsOf(of));
    auto decoder = makeLayeredDecoder(itemsOf(of), {});
    REQUIRE(encoder.ok());
    REQUIRE(decoder.ok());
    for (unsigned i = 0; i < 4; ++i) {
        Bytes records = i == 1 ? randomRecords(of, 300, i) : scannedRecords(of, 900, i, 1 + i);
        (*encoder)->start();
        (*encoder)->encode(records);
        ByteSpan chunk = (*encoder)->finish();
        CHECK(Bytes(chunk.begin(), chunk.end()) == encodeLayered(of, records));
        Bytes padded(chunk.begin(), chunk.end()), decoded(records.size());
        padded.resize(chunk.size() + decodePadding(100));
        REQUIRE((*decoder)->start({padded.data(), chunk.size()}, i == 1 ? 300 : 900).ok());
        REQUIRE((*decoder)->decode(decoded).ok());
        CHECK(decoded == records);
    }
}

TEST_CASE("layers that never change take no bytes") {
    LayeredCase of{10, 4, 3};
    Bytes one = scannedRecords(of, 1, 2, 1), records;
    for (int i = 0; i < 5000; ++i)
        records.insert(records.end(), one.begin(), one.end());
    Bytes chunk = encodeLayered(of, records);
    const std::size_t sizes = recordLengthOf(itemsOf(of)) + 4;
    for (std::size_t layer = 2; layer < 16; ++layer)
        CHECK(loadLe<std::uint32_t>(chunk.data() + sizes + 4 * layer) == 0);
    CHECK(chunk.size() < 1000);
    checkRoundTrip(of, records);
}

TEST_CASE("layers that are not wanted are zero and the others as before") {
    LayeredCase of{10, 3, 3};
    struct Field {
        std::uint32_t layer;
        std::size_t offsetBytes, sizeBytes;
        std::uint8_t mask = 0xFF;
    };
    const Field fields[] = {
        {Layers::z, 8, 4},
        {Layers::classification, 16, 1},
        {Layers::flags, 15, 1, 0xCF},
        {Layers::intensity, 12, 2},
        {Layers::scanAngle, 18, 2},
        {Layers::userData, 17, 1},
        {Layers::pointSource, 20, 2},
        {Layers::gpsTime, 22, 8},
        {Layers::rgb, 30, 6},
        {Layers::nir, 36, 2},
        {Layers::wavePacket, 38, 29},
    };
    // Some layers of the second set are constant.
    Bytes varied = scannedRecords(of, 1200, 12, 3), some = varied;
    for (std::size_t i = 0; i < 1200; ++i)
        for (std::size_t k : {16u, 17u, 36u, 37u, 67u})
            some[i * 70 + k] = some[k];
    for (const Bytes& records : {varied, some}) {
        Bytes chunk = encodeLayered(of, records);
        auto check = [&](const Layers& wanted) {
            Bytes expected = records;
            for (std::size_t i = 0; i < 1200; ++i) {
                for (const Field& field : fields)
                    for (std::size_t k = 0; k < field.sizeBytes && !wanted.has(field.layer); ++k)
                        expected[i * 70 + field.offsetBytes + k] &= static_cast<std::uint8_t>(~field.mask);
                for (std::size_t b = 0; b < 3; ++b)
                    if (!wanted.hasExtraByte(b))
                        expected[i * 70 + 67 + b] = 0;
            }
            auto decoded = decodeLayered(of, chunk, 1200, wanted);
            REQUIRE(decoded.ok());
            INFO("layers " << wanted.fields);
            CHECK(firstDifference(*decoded, expected, 70) == "");
        };
        check({0, {false, false, false}});
        check({0, {}});
        check({Layers::all, {false, true, false}});
        for (const Field& field : fields) {
            check({field.layer, {true, false, false}});
            check({~field.layer, {}});
        }
    }
}

TEST_CASE("frozen bytes: a chunk of each format and version is what it was when LASzip's own were matched") {
    auto sum = [](const Bytes& bytes) {
        std::uint64_t hash = 0xCBF29CE484222325; // FNV-1a
        for (std::uint8_t byte : bytes)
            hash = (hash ^ byte) * 0x100000001B3;
        return hash;
    };
    constexpr std::uint64_t frozen[] = {
        0x2C7B9876E8CC8E96, 0x1B0EA2D4E7F34645, 0x523CD0198C497163, 0xCF20F89DCF8FC624, 0x3C8701D413FFF2AB,
        0xFC7E55B392D80375, 0x502B5ACB958FDB5B, 0x94A1EBAC1DFEC736, 0x592D23C9D765921B, 0xABDFAE486C212C3B};
    for (int i = 0; i < 10; ++i) {
        LayeredCase of{6 + i / 2, 2, static_cast<std::uint16_t>(3 + i % 2)};
        INFO("format " << of.pointFormat << " version " << of.version);
        CHECK(sum(encodeLayered(of, scannedRecords(of, 2000, 1, 4))) == frozen[i]);
    }
}

TEST_CASE("items that no layered chunk has are refused") {
    auto refused = [](const Items& items) {
        auto decoder = makeLayeredDecoder(items, {});
        auto encoder = makeLayeredEncoder(items);
        return !decoder.ok() && decoder.error().code == ErrorCode::unsupported && !encoder.ok();
    };
    CHECK(refused({}));
    CHECK(refused({{ItemType::rgb14, 6, 3}}));
    CHECK(refused({{ItemType::point14, 30, 2}}));
    CHECK(refused({{ItemType::point14, 29, 3}}));
    CHECK(refused({{ItemType::point14, 30, 3}, {ItemType::byte, 3, 3}}));
    CHECK(refused({{ItemType::point14, 30, 3}, {ItemType::rgb14, 8, 3}}));
    CHECK(refused({{ItemType::point14, 30, 3}, {ItemType::byte14, 0, 3}}));
    CHECK(refused({{ItemType::point14, 30, 3}, {ItemType::byte14, 2, 3}, {ItemType::rgb14, 6, 3}}));
    CHECK(refused({{ItemType::point14, 30, 3}, {ItemType::rgb14, 6, 3}, {ItemType::rgbNir14, 8, 3}}));
    CHECK_FALSE(refused({{ItemType::point14, 30, 3}, {ItemType::rgb14, 6, 3}, {ItemType::byte14, 1, 3}}));
}
