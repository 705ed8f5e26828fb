#include "shared/codec/colour_codec.hpp"
#include "shared/codec/progressive_order.hpp"
#include "tests/unit/shared/codec/damage.hpp"

#include <catch2/catch.hpp>

#include <functional>

using namespace stipple;
using namespace stipple::test;

namespace {

using Values = std::vector<std::uint16_t>;

Values colours(std::uint32_t count, int channels, const std::function<std::uint16_t(int)>& ofByte) {
    std::mt19937 random(2);
    Values values;
    int level = 128;
    for (std::uint32_t i = 0; i < count; ++i) {
        level = std::clamp(level + static_cast<int>(random() % 9) - 4, 20, 235);
        for (int c = 0; c < channels; ++c)
            values.push_back(ofByte(level + static_cast<int>(random() % 20) - 10));
    }
    return values;
}

std::vector<NeighbourChoice> someChoices(std::uint32_t count, int stratum) {
    std::vector<NeighbourChoice> choices(stratum == 0 ? 0 : stratumPoints(count, stratum));
    for (std::size_t j = 0; j < choices.size(); ++j)
        choices[j] = static_cast<NeighbourChoice>(j * 7 / 3 % 3);
    return choices;
}

Bytes encode(const Values& values, std::uint32_t count, int channels) {
    ByteWriter to;
    for (int s = 0; s < strataCount; ++s)
        if (stratumPoints(count, s) > 0)
            encodeColour(to, values, channels, narrowestWidth(values), s, someChoices(count, s));
    return to.take();
}

Result<Values> decode(ByteSpan bytes, std::uint32_t count, int channels, int strata) {
    ColourDecoder decoder(count, channels, strata);
    ByteReader from(bytes);
    for (int s = 0; s < strata; ++s)
        if (stratumPoints(count, s) > 0)
            STIPPLE_CHECK(decoder.decode(s, from, someChoices(count, s)));
    return decoder.takeValues();
}

struct Kind {
    const char* name;
    ColourWidth width;
    std::function<std::uint16_t(int)> ofByte;
};
const std::vector<Kind> kinds{
    {"bytes", ColourWidth::low, [](int v) { return static_cast<std::uint16_t>(v); }},
    {"high bytes", ColourWidth::high, [](int v) { return static_cast<std::uint16_t>(v * 256); }},
    {"repeated bytes", ColourWidth::repeated, [](int v) { return static_cast<std::uint16_t>(v * 257); }},
    {"16 bits", ColourWidth::wide, [](int v) { return static_cast<std::uint16_t>(v * 271 + 5); }},
};

} // namespace

TEST_CASE("colours of every width come back in progressive order, for each prefix of strata") {
    for (const Kind& kind : kinds)
        for (int channels : {1, 3})
            for (std::uint32_t count : {1u, 2u, 5u, 16u, 1000u, 4097u}) {
                INFO(kind.name << ", " << channels << " channels, " << count << " points");
                Values values = colours(count, channels, kind.ofByte);
                CHECK(narrowestWidth(values) == kind.width);
                Bytes bytes = encode(values, count, channels);
                auto order = progressiveOrder(count);
                for (int strata = 1; strata <= strataCount; ++strata) {
                    auto read = decode(bytes, count, channels, strata);
                    REQUIRE(read.ok());
                    REQUIRE(read->size() ==
                            strataPrefixPoints(count, strata) * static_cast<std::size_t>(channels));
                    bool equal = true;
                    for (std::size_t i = 0; i < read->size(); ++i) {
                        auto c = static_cast<std::size_t>(channels);
                        equal = equal && (*read)[i] == values[order[i / c] * c + i % c];
                    }
                    CHECK(equal);
                }
            }
}

TEST_CASE("random 16-bit colours come back") {
    std::mt19937 random(8);
    Values values(3 * 999);
    for (auto& value : values)
        value = static_cast<std::uint16_t>(random());
    auto read = decode(encode(values, 999, 3), 999, 3, strataCount);
    REQUIRE(read.ok());
    Values sortedRead = *read;
    std::sort(sortedRead.begin(), sortedRead.end());
    std::sort(values.begin(), values.end());
    CHECK(sortedRead == values);
}

TEST_CASE("damaged colours are errors or as many colours") {
    for (const Kind& kind : kinds)
        forEachDamage(encode(colours(300, 3, kind.ofByte), 300, 3), 1500, [&](const Bytes& damaged) {
            auto read = decode(damaged, 300, 3, strataCount);
            CHECK((!read.ok() || read->size() == 900));
        });
}
