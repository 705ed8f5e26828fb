#include "client/core/resident_node.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

NodePicture pictureAt(int nodeBits) {
    std::uint32_t most = static_cast<std::uint32_t>((1ull << nodeBits) - 1);
    NodePicture picture;
    picture.positions = {{0, 0, 0},
                         {most, most, most},
                         {most, 0, 0},
                         {0, most, 0},
                         {0, 0, most},
                         {most / 3, most / 5, most / 7},
                         {1 % (most + 1), 2 % (most + 1), 4 % (most + 1)}};
    return picture;
}

} // namespace

TEST_CASE("packed positions come back exactly for every node width") {
    int bits = GENERATE(1, 5, 20, 21, 22, 25, 30, 31);
    NodePicture picture = pictureAt(bits);
    ResidentNode node = packNode({3, 1, 2, 3}, bits, 100, picture, PictureColour::none, false);
    CHECK(node.positionShift == std::max(0, bits - 21));
    CHECK(node.positionLowWords.empty() == (bits <= 21));
    CHECK(node.pointCount == picture.size());
    CHECK(node.totalPoints == 100);
    for (std::size_t i = 0; i < picture.size(); ++i)
        CHECK(positionOf(node, i) == picture.positions[i]);
}

TEST_CASE("16-bit colours keep their upper byte, 8-bit ones are taken as they are") {
    NodePicture picture;
    picture.positions = {{1, 2, 3}};
    picture.colour = {0xFFFF, 0x0100, 0x00FF};
    ResidentNode wide = packNode({}, 10, 1, picture, PictureColour::rgb, false);
    REQUIRE(wide.colourWords.size() == 1);
    CHECK(wide.colourWords[0] == 0xFF0001FFu);
    picture.colour = {255, 16, 300};
    ResidentNode narrow = packNode({}, 10, 1, picture, PictureColour::rgb, true);
    CHECK(narrow.colourWords[0] == 0xFFFF10FFu);
    CHECK(narrow.columns.columns.empty());
}

TEST_CASE("what is shown of a node's colours is kept to the last bit, in words or beside them") {
    auto keeps = [](std::vector<std::uint16_t> colour, bool is8Bit, std::uint32_t unit, std::size_t columns) {
        NodePicture picture;
        picture.positions.resize(colour.size() / 3);
        picture.colour = colour;
        auto points = static_cast<std::uint32_t>(picture.size());
        ResidentNode node = packNode({}, 10, points, picture, PictureColour::rgb, is8Bit);
        CHECK(shownColours(node).empty());
        keepShownColours(node, picture);
        CHECK(node.shownUnit == unit);
        CHECK(node.columns.columns.size() == columns);
        Bytes shown = shownColours(node);
        REQUIRE(shown.size() == 2 * colour.size());
        for (std::size_t i = 0; i < colour.size(); ++i)
            CHECK(loadLe<std::uint16_t>(shown.data() + 2 * i) == colour[i]);
    };
    keeps({0xFFFF, 0x0101, 0}, false, 257, 0);
    keeps({0xFF00, 0x0100, 0}, false, 256, 0);
    keeps({255, 17, 0}, true, 1, 0);
    keeps({255, 17, 0}, false, 0, 1);
    keeps({0xFFFF, 0x0102, 0}, false, 0, 1);
}

TEST_CASE("an intensity picture has a column of intensities and no colour words") {
    NodePicture picture;
    picture.positions = {{1, 2, 3}, {4, 5, 6}};
    picture.colour = {0, 65535};
    ResidentNode node = packNode({}, 10, 2, picture, PictureColour::intensity, false);
    CHECK(node.colourWords.empty());
    CHECK(node.columns == NodeColumns{2, {{pictureIntensity, 2}}, {0, 0, 255, 255}});
}

TEST_CASE("every packed node has an id of its own") {
    NodePicture picture = pictureAt(4);
    ResidentNode a = packNode({}, 4, 9, picture, PictureColour::none, false);
    ResidentNode b = packNode({}, 4, 9, picture, PictureColour::none, false);
    CHECK(a.id != b.id);
    CHECK(a.sizeBytes() >= 8 * a.pointCount);
}
