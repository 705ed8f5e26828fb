#include "shared/las/laz/integer_compressor.hpp"

#include <catch2/catch.hpp>

#include <memory>
#include <random>

using namespace stipple;
using namespace stipple::las::laz;

namespace {

// mt19937 gives its 32 bits in a type that may be wider.
struct Random {
    std::mt19937 engine;
    explicit Random(std::uint32_t seed) : engine(seed) {}
    std::uint32_t operator()() { return static_cast<std::uint32_t>(engine()); }
};

// The encoded bytes with room behind them for the decoder to run on.
Bytes padded(ByteSpan bytes) {
    Bytes copy(bytes.begin(), bytes.end());
    copy.resize(bytes.size() + 64);
    return copy;
}

template <unsigned Symbols>
void requireSymbolRoundTrip(double skew) {
    Random random(Symbols);
    std::geometric_distribution<unsigned> peaked(skew);
    std::vector<unsigned> symbols(30000);
    for (unsigned& symbol : symbols)
        symbol = skew > 0 ? std::min(peaked(random.engine), Symbols - 1) : random() % Symbols;
    SymbolModel<Symbols> model;
    model.init();
    EncodedStream stream;
    stream.start();
    for (unsigned symbol : symbols) {
        stream.ensureRoom(ArithmeticEncoder::maxBytesPerCall);
        stream.encoder.encodeSymbol(model, symbol);
    }
    ByteSpan encoded = stream.finish();
    Bytes bytes = padded(encoded);
    model.init();
    ArithmeticDecoder decoder(bytes.data());
    for (unsigned symbol : symbols)
        REQUIRE(decoder.decodeSymbol(model) == symbol);
    CHECK(decoder.position() == bytes.data() + encoded.size());
}

} // namespace

TEST_CASE("symbols come back, and the decoder ends where the encoder did", "[laz]") {
    for (double skew : {0.0, 0.05, 0.5, 0.999}) {
        requireSymbolRoundTrip<2>(skew);
        requireSymbolRoundTrip<6>(skew);
        requireSymbolRoundTrip<16>(skew);
        requireSymbolRoundTrip<17>(skew);
        requireSymbolRoundTrip<64>(skew);
        requireSymbolRoundTrip<256>(skew);
        requireSymbolRoundTrip<516>(skew);
        requireSymbolRoundTrip<2048>(skew);
    }
}

TEST_CASE("a certain symbol costs next to nothing, an even one its bits", "[laz]") {
    auto encodedSize = [](auto symbolAt) {
        SymbolModel<256> model;
        model.init();
        EncodedStream stream;
        stream.start();
        Random random(1);
        for (int i = 0; i < 100000; ++i) {
            stream.ensureRoom(ArithmeticEncoder::maxBytesPerCall);
            stream.encoder.encodeSymbol(model, symbolAt(random));
        }
        return stream.finish().size();
    };
    CHECK(encodedSize([](auto&) { return 7u; }) < 1000);
    std::size_t even = encodedSize([](auto& random) { return random() & 255; });
    CHECK(even > 100000);
    CHECK(even < 101000);
}

TEST_CASE("bits and raw numbers come back", "[laz]") {
    std::mt19937_64 random(3);
    BitModel model;
    EncodedStream stream;
    stream.start();
    for (int i = 0; i < 5000; ++i) {
        stream.ensureRoom(10 * ArithmeticEncoder::maxBytesPerCall);
        std::uint64_t value = random();
        stream.encoder.encodeBit(model, value % 10 == 0);
        unsigned count = 1 + static_cast<unsigned>(value % 32);
        stream.encoder.writeBits(count, static_cast<std::uint32_t>(value) & (0xFFFFFFFFu >> (32 - count)));
        stream.encoder.writeInt(static_cast<std::uint32_t>(value));
        stream.encoder.writeInt64(value);
    }
    ByteSpan encoded = stream.finish();
    Bytes bytes = padded(encoded);
    random.seed(3);
    model.init();
    ArithmeticDecoder decoder(bytes.data());
    for (int i = 0; i < 5000; ++i) {
        std::uint64_t value = random();
        REQUIRE(decoder.decodeBit(model) == (value % 10 == 0));
        unsigned count = 1 + static_cast<unsigned>(value % 32);
        REQUIRE(decoder.readBits(count) ==
                (static_cast<std::uint32_t>(value) & (0xFFFFFFFFu >> (32 - count))));
        REQUIRE(decoder.readInt() == static_cast<std::uint32_t>(value));
        REQUIRE(decoder.readInt64() == value);
    }
    CHECK(decoder.position() == bytes.data() + encoded.size());
}

TEST_CASE("an encoder carries over any number of full bytes", "[laz]") {
    // The top of the range again and again: bytes of 0xFF that a last carry turns.
    EncodedStream stream;
    stream.start();
    for (int i = 0; i < 1000; ++i) {
        stream.ensureRoom(ArithmeticEncoder::maxBytesPerCall);
        stream.encoder.writeBits(16, 0xFFFF);
    }
    Bytes bytes = padded(stream.finish());
    ArithmeticDecoder decoder(bytes.data());
    for (int i = 0; i < 1000; ++i)
        REQUIRE(decoder.readBits(16) == 0xFFFF);
}

namespace {

template <unsigned Bits, unsigned Contexts>
void requireIntegerRoundTrip(std::uint32_t spread) {
    Random random(Bits + spread);
    auto value = [&](std::uint32_t around) {
        std::uint32_t v = around + (spread == 0 ? random() : random() % spread - spread / 2);
        return static_cast<std::int32_t>(Bits == 32 ? v : v & ((1u << (Bits % 32)) - 1));
    };
    std::vector<std::array<std::int32_t, 2>> pairs(5000);
    for (auto& [predicted, real] : pairs) {
        predicted = value(random());
        real = value(static_cast<std::uint32_t>(predicted));
    }
    if (Bits == 32)
        pairs[7] = {0, std::numeric_limits<std::int32_t>::min()}; // a correction of 32 bits
    using Compressor = IntegerCompressor<Bits, Contexts>;
    auto compressor = std::make_unique<Compressor>();
    compressor->init();
    EncodedStream stream;
    stream.start();
    std::vector<unsigned> sizes;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        stream.ensureRoom(Compressor::maxBytes);
        compressor->compress(stream.encoder, pairs[i][0], pairs[i][1], static_cast<unsigned>(i % Contexts));
        sizes.push_back(compressor->k());
    }
    ByteSpan encoded = stream.finish();
    Bytes bytes = padded(encoded);
    compressor->init();
    ArithmeticDecoder decoder(bytes.data());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        REQUIRE(compressor->decompress(decoder, pairs[i][0], static_cast<unsigned>(i % Contexts)) ==
                pairs[i][1]);
        REQUIRE(compressor->k() == sizes[i]);
    }
    CHECK(decoder.position() == bytes.data() + encoded.size());
}

} // namespace

TEST_CASE("integers come back from corrections of any size", "[laz]") {
    for (std::uint32_t spread : {2u, 100u, 1000000u, 0u}) {
        requireIntegerRoundTrip<8, 2>(spread);
        requireIntegerRoundTrip<16, 4>(spread);
        requireIntegerRoundTrip<32, 22>(spread);
    }
}

TEST_CASE("any bytes decode to symbols of the model", "[laz]") {
    Random random(5);
    auto model = std::make_unique<SymbolModel<516>>();
    auto compressor = std::make_unique<IntegerCompressor<32>>();
    for (int run = 0; run < 200; ++run) {
        Bytes bytes(20064);
        // Streams of 0xFF first: a value above any that an encoder writes.
        for (std::size_t i = run % 2 ? 4 : 0; i < 20000; ++i)
            bytes[i] = static_cast<std::uint8_t>(random());
        if (run % 2)
            std::fill_n(bytes.begin(), 4 + run, std::uint8_t{0xFF});
        model->init();
        compressor->init();
        ArithmeticDecoder decoder(bytes.data());
        for (int i = 0; i < 1000; ++i) {
            REQUIRE(decoder.decodeSymbol(*model) < 516);
            compressor->decompress(decoder, 0);
        }
    }
}
