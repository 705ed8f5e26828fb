#include "client/core/attribute_needs.hpp"

#include <catch2/catch.hpp>

#include <limits>

using namespace stipple;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

CloudMetadata cloudWith(InnerColour inner) {
    using namespace attribute_names;
    CloudMetadata metadata;
    auto add = [&](std::string_view name, AttributeType type, double min, double max) {
        metadata.schema.attributes.push_back({std::string(name), type});
        metadata.statistics.push_back({min, max, (min + max) / 2, 1, {}});
    };
    add(intensity, AttributeType::u16, 10, 900);
    add(returnNumber, AttributeType::u8, 1, 4);
    add(numberOfReturns, AttributeType::u8, 1, 5);
    add(classification, AttributeType::u8, 1, 6);
    add(gpsTime, AttributeType::f64, 1e8, 2e8);
    for (std::string_view name : {red, green, blue})
        add(name, AttributeType::u16, 0, 65535);
    metadata.statistics[3].histogram = {{1, 5}, {2, 7}, {6, 1}};
    metadata.schema.attributes[0].scale = 0.1; // 1 … 90
    metadata.pictureColour = PictureColour::rgb;
    metadata.innerColour = inner;
    metadata.pointCount = 13;
    return metadata;
}

} // namespace

TEST_CASE("a style needs the blocks of what it shows and of what it hides by") {
    CloudMetadata cloud =
        cloudWith(InnerColour::exact); // blocks: Intensity, returns, Classification, GPS Time
    ColourStyle style;
    CHECK(needsOf(style, cloud) == AttributeNeeds{});
    style.colourMode = ColourMode::numberOfReturns;
    CHECK(needsOf(style, cloud).blocks == std::vector<int>{1});
    CHECK(columnBytes(needsOf(style, cloud), cloud) == 2);
    style.filters = {{"gps time", 0, 1}, {"Return Number", 1, 1}, {"Red", 0, 5}, {"nonsense", 0, 1}};
    CHECK(needsOf(style, cloud).blocks == std::vector<int>{1, 3});
    style.hiddenClasses.set(2);
    CHECK(needsOf(style, cloud).blocks == std::vector<int>{1, 2, 3});
    CHECK(columnBytes(needsOf(style, cloud), cloud) == 2 + 1 + 8);
    ColourStyle mix;
    mix.mix = {{ColourMode::intensity, "", {}, 1}, {ColourMode::attribute, "GPS Time", {}, 1}};
    CHECK(needsOf(mix, cloud).blocks.empty());
    mix.colourMode = ColourMode::mix;
    CHECK(needsOf(mix, cloud).blocks == std::vector<int>{0, 3});
}

TEST_CASE("exact colours are of use to styles that show colours, where inner nodes have means") {
    CloudMetadata cloud = cloudWith(InnerColour::mean);
    ColourStyle style;
    CHECK(needsOf(style, cloud).exactBlock == 0);
    CHECK(needsOf(style, cloud).blocks.empty());
    style.colourMode = ColourMode::intensity;
    CHECK(needsOf(style, cloud) == AttributeNeeds{{1}, -1});
    style.filters = {{"Green", 0, 5}};
    CHECK(needsOf(style, cloud).exactBlock == 0);

    cloud.pictureColour = PictureColour::intensity;
    style = {};
    CHECK(needsOf(style, cloud).exactBlock == -1);
    style.colourMode = ColourMode::intensity;
    CHECK(needsOf(style, cloud) == AttributeNeeds{{}, 0});
}

TEST_CASE("a cloud is hidden whole when its statistics say that no point can pass") {
    CloudMetadata cloud = cloudWith(InnerColour::exact);
    auto hides = [&](const AttributeFilter& filter) {
        ColourStyle style;
        style.filters = {filter};
        return hidesAll(style, cloud);
    };
    CHECK_FALSE(hides({"Intensity", 90, infinity}));
    CHECK(hides({"Intensity", 90.01, infinity}));
    CHECK_FALSE(hides({"Intensity", -infinity, 1}));
    CHECK(hides({"Intensity", -infinity, 0.99}));
    CHECK(hides({"Return Number", 5, 9}));
    CHECK_FALSE(hides({"Return Number", 1.2, 1.3})); // no value lies there, but only the points know
    CHECK_FALSE(hides({"nonsense", 5, 9}));

    ColourStyle classes;
    classes.hiddenClasses.set(1).set(2);
    CHECK_FALSE(hidesAll(classes, cloud));
    classes.hiddenClasses.set(6);
    CHECK(hidesAll(classes, cloud));
    cloud.statistics[3].histogram.clear(); // too many values to be counted
    CHECK_FALSE(hidesAll(classes, cloud));
}

TEST_CASE("normals are of use to discs alone, and a cloud without is said to have none") {
    CloudMetadata cloud = cloudWith(InnerColour::exact);
    Style style;
    style.shape = PointShape::disc;
    CHECK(needsOf(style, cloud) == AttributeNeeds{});
    CHECK(lackOf(style, cloud, "town").find("town has no normals") == 0);
    for (const char* name : {"NormalX", "NormalY", "NormalZ"})
        cloud.schema.attributes.push_back({name, AttributeType::f32});
    CHECK(needsOf(style, cloud).blocks == std::vector<int>{4, 5, 6});
    CHECK(columnBytes(needsOf(style, cloud), cloud) == 12);
    CHECK(lackOf(style, cloud, "town").empty());
    style.sizePixels = 1;
    CHECK(lackOf(style, cloud, "town").find("single pixel") != std::string::npos);
    for (PointShape shape : {PointShape::square, PointShape::circle, PointShape::paraboloid}) {
        style.shape = shape;
        CHECK(needsOf(style, cloud) == AttributeNeeds{});
        CHECK(lackOf(style, cloudWith(InnerColour::exact), "town").empty());
    }
}
