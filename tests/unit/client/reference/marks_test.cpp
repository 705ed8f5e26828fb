#include "client/reference/marks.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace stipple;
using reference::Mark;
using reference::neededAttributes;
using reference::Points;
using reference::View;

namespace {

// Points on the y axis, ahead of a camera at the origin with slope 1; 100 × 100 pixels.
struct Line {
    Grid grid{{0.5, 0.5, 0.5}, {0, 0, 0}};
    PointBatch batch;
    Points points;
    View view;
    Style style;

    explicit Line(std::vector<Vec3i> positions, std::vector<Attribute> attributes = {}) {
        points.attributes = std::move(attributes);
        batch.resize({points.attributes}, positions.size());
        batch.positions = std::move(positions);
        points.grid = &grid;
        points.batch = &batch;
        Camera camera;
        camera.position = {0, 0, 0};
        camera.target = {0, 1, 0};
        camera.fovYDegrees = 90;
        view = reference::viewOf(camera, 100, 100, {});
    }
    std::vector<Mark> marks() {
        std::vector<Mark> result;
        appendMarks(view, style, points, result);
        return result;
    }
};

Attribute attribute(std::string_view name, AttributeType type) {
    return {std::string(name), type};
}

std::vector<Attribute> rgb() {
    return {attribute(attribute_names::red, AttributeType::u16),
            attribute(attribute_names::green, AttributeType::u16),
            attribute(attribute_names::blue, AttributeType::u16)};
}

} // namespace

TEST_CASE("marks lie where the view puts the points, in their order") {
    Line line({{0, 20, 0}, {4, 20, 0}, {0, -20, 0}, {0, 40, 0}});
    line.points.firstOrder = 1000;
    auto marks = line.marks();
    REQUIRE(marks.size() == 3); // one is behind
    CHECK(marks[0].x == Approx(50));
    CHECK(marks[1].x == Approx(50 + 50 * 2 / 10.0));
    CHECK(marks[1].order == 1001);
    CHECK(marks[2].order == 1003);
    CHECK(marks[2].distance == Approx(20));
}

TEST_CASE("points that can't touch the picture leave no mark, those that may do") {
    // 10 ahead the picture ends 10 aside; one pixel is 0.2 wide.
    Line line({{-21, 20, 0}, {-24, 20, 0}, {0, 20, 21}, {0, 20, 24}});
    line.style.sizePixels = 6;
    auto marks = line.marks();
    REQUIRE(marks.size() == 2);
    CHECK(marks[0].order == 0);
    CHECK(marks[1].order == 2);
}

TEST_CASE("sizes are fixed, or shrink with the distance, between their limits") {
    Line line({{0, 20, 0}, {0, 200, 0}, {0, 2, 0}});
    line.style.sizePixels = 3.7;
    for (const Mark& mark : line.marks())
        CHECK(mark.diameter == 3.7);
    line.style.sizeMode = PointSizeMode::world;
    line.style.sizeWorld = 1;
    line.style.minSizePixels = 2;
    line.style.maxSizePixels = 20;
    auto marks = line.marks();
    CHECK(marks[0].diameter == Approx(5)); // 50 / 10
    CHECK(marks[1].diameter == 2);
    CHECK(marks[2].diameter == 20);
    line.style.minSizePixels = 0.2; // never below a pixel
    CHECK(line.marks()[1].diameter == 1);
    line.style.maxSizePixels = 1000;
    line.style.sizeWorld = 1000;
    CHECK(line.marks()[2].diameter == 255);
}

TEST_CASE("RGB is taken by the upper byte, or as it is where channels have 8 bits") {
    Line line({{0, 20, 0}, {0, 20, 0}}, rgb());
    for (int c = 0; c < 3; ++c) {
        line.batch.setValue<std::uint16_t>(c, 0, static_cast<std::uint16_t>(0x1234 + 0x2000 * c));
        line.batch.setValue<std::uint16_t>(c, 1, static_cast<std::uint16_t>(c == 2 ? 300 : 7 + c));
    }
    CHECK(line.marks()[0].colour == reference::Colour{0x12, 0x32, 0x52});
    line.points.colourIs8Bit = true;
    CHECK(line.marks()[1].colour == reference::Colour{7, 8, 255});
}

TEST_CASE("what the cloud lacks is light grey") {
    Line line({{0, 20, 0}});
    for (ColourMode mode : {ColourMode::rgb, ColourMode::intensity}) {
        line.style.colourMode = mode;
        line.style.intensityRange = {0, 1};
        CHECK(line.marks()[0].colour == reference::Colour{180, 180, 180});
    }
}

TEST_CASE("intensity of any type and elevation go along the gradient, clamped at its ends") {
    const std::pair<AttributeType, int> types[] = {{AttributeType::u8, 1},
                                                   {AttributeType::u16, 2},
                                                   {AttributeType::i32, 4},
                                                   {AttributeType::f32, 4},
                                                   {AttributeType::f64, 8}};
    for (auto [type, size] : types) {
        Line line({{0, 20, 0}, {0, 20, 0}, {0, 20, 0}}, {attribute(attribute_names::intensity, type)});
        for (std::size_t i = 0; i < 3; ++i) {
            int value = static_cast<int>(100 * i);
            if (type == AttributeType::f32)
                line.batch.setValue<float>(0, i, static_cast<float>(value));
            else if (type == AttributeType::f64)
                line.batch.setValue<double>(0, i, value);
            else
                line.batch.columns[0][i * static_cast<std::size_t>(size)] = static_cast<std::uint8_t>(value);
        }
        line.style.colourMode = ColourMode::intensity;
        line.style.gradient = GradientName::grey;
        line.style.intensityRange = {50, 150};
        auto marks = line.marks();
        CHECK(marks[0].colour[0] == 0);
        CHECK(marks[1].colour[0] == Approx(127.5).margin(0.5));
        CHECK(marks[2].colour[2] == 255);
    }
    Line line({{0, 40, 4}, {0, 40, 8}});
    line.style.colourMode = ColourMode::elevation;
    line.style.gradient = GradientName::grey;
    line.style.elevationRange = {1, 5};
    CHECK(line.marks()[0].colour[1] == Approx(255 / 4.0).margin(0.5));
    CHECK(line.marks()[1].colour[1] == Approx(255 * 3 / 4.0).margin(0.5));
}

TEST_CASE("only the attributes that the colours need are asked for") {
    CloudMetadata metadata;
    metadata.schema.attributes = rgb();
    metadata.schema.attributes.push_back(attribute(attribute_names::intensity, AttributeType::u16));
    metadata.pictureColour = PictureColour::rgb;
    Style style;
    CHECK(neededAttributes(style, metadata).size() == 3);
    style.colourMode = ColourMode::intensity;
    CHECK(neededAttributes(style, metadata).size() == 1);
    style.colourMode = ColourMode::elevation;
    CHECK(neededAttributes(style, metadata).empty());
    metadata.pictureColour = PictureColour::none;
    style.colourMode = ColourMode::rgb;
    CHECK(neededAttributes(style, metadata).empty());
}
