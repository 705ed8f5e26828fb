#include "shared/codec/colour_codec.hpp"
#include "shared/codec/exact_colour.hpp"
#include "shared/codec/progressive_order.hpp"
#include "tests/unit/shared/codec/damage.hpp"

#include <catch2/catch.hpp>

#include <numeric>

using namespace stipple;
using namespace stipple::test;

namespace {

using Values = std::vector<std::uint16_t>;

Values randomValues(std::size_t count, std::uint32_t unit, std::uint32_t most, std::uint32_t seed) {
    std::mt19937 random(seed);
    Values values(count);
    for (std::uint16_t& value : values)
        value = static_cast<std::uint16_t>(random() % (most + 1) * unit);
    return values;
}

Bytes encode(const Values& exact, const Values& shown, int channels) {
    ByteWriter to;
    writeExactColour(to, exact, shown, channels, narrowestWidth(exact));
    return to.take();
}

std::vector<std::uint32_t> inOrder(std::size_t count) {
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0);
    return order;
}

// A little off the exact ones.
Values near(const Values& exact, std::uint32_t unit) {
    Values shown = exact;
    for (std::size_t i = 0; i < shown.size(); ++i)
        shown[i] =
            static_cast<std::uint16_t>(std::clamp(int(shown[i] / unit) + int(i % 7) - 3, 0, 255) * unit);
    return shown;
}

} // namespace

TEST_CASE("exact colours of every width come back from shown ones of every width") {
    for (std::uint32_t unit : {1u, 256u, 257u, 0u}) // 0: all 16 bits
        for (std::uint32_t shownUnit : {1u, 256u, 257u, 0u})
            for (int channels : {1, 3})
                for (std::size_t count : {std::size_t{1}, std::size_t{2}, std::size_t{999}}) {
                    std::size_t values = count * static_cast<std::size_t>(channels);
                    Values exact = randomValues(values, std::max(unit, 1u), unit == 0 ? 65535 : 255, 1),
                           shown =
                               randomValues(values, std::max(shownUnit, 1u), shownUnit == 0 ? 65535 : 255, 2);
                    Bytes bytes = encode(exact, shown, channels);
                    ByteReader from(bytes);
                    REQUIRE(readExactColour(from, inOrder(count), channels, shown).ok());
                    CHECK(from.remaining() == 0);
                    CHECK(shown == exact);
                }
}

TEST_CASE("exact colours are given out in the order that is asked for") {
    Values exact = randomValues(300, 1, 255, 3), shown = near(exact, 1);
    Bytes bytes = encode(exact, shown, 3);
    std::vector<std::uint32_t> order = progressiveOrder(100);
    Values colours;
    for (std::uint32_t i : order)
        colours.insert(colours.end(), shown.begin() + 3 * i, shown.begin() + 3 * i + 3);
    ByteReader from(bytes);
    REQUIRE(readExactColour(from, order, 3, colours).ok());
    for (std::size_t place = 0; place < order.size(); ++place)
        for (std::size_t c = 0; c < 3; ++c)
            CHECK(colours[3 * place + c] == exact[3 * order[place] + c]);
}

TEST_CASE("what differs little from what is shown takes few bytes, and what is simpler is stored plainly") {
    Values noise = randomValues(3000, 257, 255, 4);
    CHECK(encode(noise, near(noise, 257), 3).size() < 1400); // 7 values a channel: 2.8 bits
    Values twoColours = randomValues(3000, 255, 1, 5);
    CHECK(encode(twoColours, noise, 3).size() < 700);
}

TEST_CASE("colours are rounded to what their width holds") {
    Values values{0, 1, 127, 128, 129, 255, 256, 65535};
    auto rounded = [&](ColourWidth width) {
        Values copy = values;
        roundTo(width, copy);
        CHECK((width == ColourWidth::wide || narrowestWidth(copy) != ColourWidth::wide));
        return copy;
    };
    CHECK(rounded(ColourWidth::wide) == values);
    CHECK(rounded(ColourWidth::low) == Values{0, 1, 127, 128, 129, 255, 255, 255});
    CHECK(rounded(ColourWidth::high) == Values{0, 0, 0, 256, 256, 256, 256, 65280});
    CHECK(rounded(ColourWidth::repeated) == Values{0, 0, 0, 0, 257, 257, 257, 65535});
}

TEST_CASE("damaged exact colours are errors or colours") {
    for (std::uint32_t unit : {1u, 271u}) {
        Values exact = randomValues(900, unit, 241, 6), shown = near(exact, 1);
        forEachDamage(encode(exact, shown, 3), 1500, [&](const Bytes& damaged) {
            Values colours = shown;
            ByteReader from(damaged);
            Status read = readExactColour(from, inOrder(300), 3, colours);
            CHECK((read.ok() || !read.error().what.empty()));
        });
    }
}
