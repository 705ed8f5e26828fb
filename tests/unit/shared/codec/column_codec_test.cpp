#include "shared/codec/column_codec.hpp"
#include "tests/unit/shared/codec/damage.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

Bytes random(std::size_t size, unsigned spread) {
    std::mt19937 engine(6);
    Bytes bytes(size);
    for (auto& byte : bytes)
        byte = static_cast<std::uint8_t>(engine() % spread);
    return bytes;
}

template <class T>
Bytes bytesOf(const std::vector<T>& values) {
    Bytes bytes(values.size() * sizeof(T));
    std::memcpy(bytes.data(), values.data(), bytes.size());
    return bytes;
}

Bytes encode(const Bytes& values, std::size_t width, std::size_t components) {
    ByteWriter to;
    encodeColumn(to, values, width, components);
    return to.take();
}

void checkRoundTrip(const Bytes& values, std::size_t width, std::size_t components) {
    Bytes bytes = encode(values, width, components);
    ByteReader from(bytes);
    auto read = decodeColumn(from, values.size() / width / components, width, components);
    REQUIRE(read.ok());
    CHECK(*read == values);
    CHECK(from.remaining() == 0);
}

// GPS times of a scan: four returns of a pulse, in several flight lines, in no order.
std::vector<double> gpsTimes(std::size_t count) {
    std::mt19937 engine(1);
    std::vector<double> times;
    for (std::size_t i = 0; i < count; ++i)
        times.push_back(3.0e8 + 1000.0 * static_cast<double>(engine() % 3) +
                        2e-5 * static_cast<double>(engine() % (count / 4)));
    return times;
}

} // namespace

TEST_CASE("columns of every width and number of components come back") {
    for (std::size_t width : {1u, 2u, 4u, 8u})
        for (std::size_t components : {1u, 3u, 255u})
            for (std::size_t points : {1u, 2u, 100u, 1500u})
                for (unsigned spread : {1u, 2u, 256u}) {
                    INFO(width << " bytes × " << components << ", " << points << " points, " << spread
                               << " byte values");
                    checkRoundTrip(random(width * components * points, spread), width, components);
                }
}

TEST_CASE("every bit pattern of a time survives, NaN included") {
    std::vector<double> times = gpsTimes(1000);
    times[3] = std::numeric_limits<double>::quiet_NaN();
    times[4] = -0.0;
    times[5] = 0.0;
    times[6] = -std::numeric_limits<double>::infinity();
    times[7] = std::numeric_limits<double>::denorm_min();
    Bytes bytes = bytesOf(times);
    storeLe<std::uint64_t>(bytes.data() + 8 * 8, 0xFFF4DEADBEEF0001ull); // a signalling NaN with a payload
    checkRoundTrip(bytes, 8, 1);
}

TEST_CASE("times of many ranks come back and are small") {
    for (std::size_t count : {300u, 5000u, 300000u}) {
        Bytes bytes = bytesOf(gpsTimes(count));
        checkRoundTrip(bytes, 8, 1);
        CHECK(encode(bytes, 8, 1).size() < bytes.size() / 2);
    }
}

TEST_CASE("a constant takes its own size and a byte") {
    CHECK(encode(Bytes(8 * 10000, 7), 8, 1).size() == 9);
}

TEST_CASE("damaged columns are errors or as many values") {
    std::vector<Bytes> columns{encode(bytesOf(gpsTimes(500)), 8, 1), encode(random(500, 7), 1, 1),
                               encode(random(2000, 250), 2, 2)};
    std::size_t widths[] = {8, 1, 2}, components[] = {1, 1, 2};
    for (std::size_t i = 0; i < columns.size(); ++i)
        forEachDamage(columns[i], 2000, [&](const Bytes& damaged) {
            ByteReader from(damaged);
            auto read = decodeColumn(from, 500, widths[i], components[i]);
            CHECK((!read.ok() || read->size() == 500 * widths[i] * components[i]));
        });
}
