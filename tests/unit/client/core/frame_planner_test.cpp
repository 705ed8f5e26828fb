#include "client/core/frame_planner.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace stipple;

namespace {

std::shared_ptr<ResidentNode> nodeOf(NodeKey key, int bits) {
    auto node = std::make_shared<ResidentNode>();
    node->key = key;
    node->nodeBits = bits;
    node->pointCount = 10;
    return node;
}

std::shared_ptr<CloudMetadata> cloudWith(double points, double mean, double deviation, double min,
                                         double max) {
    auto metadata = std::make_shared<CloudMetadata>();
    metadata->schema.attributes.emplace_back().name = "Intensity";
    metadata->statistics.push_back({min, max, mean, deviation, {}});
    metadata->pointCount = static_cast<std::uint64_t>(points);
    metadata->bounds.extend(Vec3i{0, 0, static_cast<std::int64_t>(1000 * min)});
    metadata->bounds.extend(Vec3i{0, 0, static_cast<std::int64_t>(1000 * max)});
    return metadata;
}

} // namespace

TEST_CASE("grid positions give the coordinate back, whatever the offset") {
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (double offset : {0.0, 500000.0, -1e9, 1e9})
        for (double scale : {1.0, 0.01, 0.001, 1e-6, 0.0003048006})
            for (int i = 0; i < 2000; ++i) {
                double world = offset + unit(random) * scale * 1e9;
                GridPosition at = gridPosition(world, offset, scale);
                REQUIRE(at.fraction >= 0);
                REQUIRE(at.fraction < 1);
                long double back = static_cast<long double>(offset) +
                                   static_cast<long double>(scale) * (static_cast<long double>(at.cell) +
                                                                      static_cast<long double>(at.fraction));
                long double steps =
                    (back - static_cast<long double>(world)) / static_cast<long double>(scale);
                REQUIRE(std::abs(static_cast<double>(steps)) < 1e-9);
            }
}

TEST_CASE("grid positions far outside any grid stay in range") {
    for (double world : {1e300, -1e300, 1e30}) {
        GridPosition at = gridPosition(world, 0, 0.001);
        CHECK(std::abs(static_cast<double>(at.cell)) == 0x1p61);
        CHECK(at.fraction == 0);
    }
}

TEST_CASE("the camera's cell stays in the node, and the fraction holds what is outside") {
    CloudMetadata metadata;
    metadata.grid = {{1, 1, 1}, {0, 0, 0}};
    metadata.rootCube = {{0, 0, 0}, 10};
    metadata.spacing = 4;
    NodeKey key{2, 1, 1, 1}; // steps 256..511 on each axis
    DrawNode draw = planNode(nodeOf(key, 8), 99, metadata, {300.25, 200.5, 600.75});
    CHECK(draw.cameraCell == std::array<std::int32_t, 3>{44, 0, 256});
    CHECK(draw.cameraFraction == std::array<float, 3>{0.25f, -55.5f, 88.75f});
    CHECK(draw.pointCount == 10);
    CHECK(draw.spacing == 1);
}

TEST_CASE("even the widest node keeps its camera in 32 bits") {
    CloudMetadata metadata;
    metadata.grid = {{1, 1, 1}, {0, 0, 0}};
    metadata.rootCube = {{0, 0, 0}, 31};
    DrawNode draw = planNode(nodeOf({}, 31), 1, metadata, {1e18, -1e18, 0x1p31});
    CHECK(draw.cameraCell == std::array<std::int32_t, 3>{INT32_MAX, 0, INT32_MAX});
    CHECK(draw.cameraFraction[0] == Approx(1e18));
    CHECK(draw.cameraFraction[1] == Approx(-1e18));
    CHECK(draw.cameraFraction[2] == 1.0f);
}

TEST_CASE("ranges come from the clouds where the style leaves them open") {
    std::vector<std::shared_ptr<const CloudMetadata>> clouds{cloudWith(100, 50, 10, 0, 60)};
    Style style = resolvedStyle(Style{}, clouds);
    CHECK(style.intensityRange == Range{30, 60}); // 50 ± 20, at most 60
    CHECK(style.elevationRange.min == Approx(0));
    CHECK(style.elevationRange.max == Approx(60));

    // A second cloud with three times the points; together: mean 35, deviation sqrt(175).
    clouds.push_back(cloudWith(300, 30, 10, -100, 100));
    style = resolvedStyle(Style{}, clouds);
    CHECK(style.intensityRange.min == Approx(35 - 2 * std::sqrt(175.0)));
    CHECK(style.intensityRange.max == Approx(35 + 2 * std::sqrt(175.0)));

    Style fixed;
    fixed.intensityRange = {1, 2};
    fixed.elevationRange = {-5, 5};
    fixed.levelRange = {0, 3};
    CHECK(resolvedStyle(fixed, clouds) == fixed);

    Style attribute;
    attribute.colourMode = ColourMode::attribute;
    attribute.attribute = "intensity";
    CHECK(resolvedStyle(attribute, clouds).attributeRange == Range{-100, 100});
    attribute.colourMode = ColourMode::mix;
    attribute.mix = {{ColourMode::attribute, "Intensity", {}, 1}, {ColourMode::elevation, "", {3, 4}, 1}};
    CHECK(resolvedStyle(attribute, clouds).mix[0].range == Range{-100, 100});
    CHECK(resolvedStyle(attribute, clouds).mix[1].range == Range{3, 4});
    attribute.mix[0].attribute = "nonsense";
    CHECK(resolvedStyle(attribute, clouds).mix[0].range == Range{0, 1});
}

TEST_CASE("a resolved range is never empty") {
    std::vector<std::shared_ptr<const CloudMetadata>> none, flat{cloudWith(10, 7, 0, 7, 7)};
    for (const auto& clouds : {none, flat}) {
        Style style = resolvedStyle(Style{}, clouds);
        CHECK(static_cast<float>(style.intensityRange.min) < static_cast<float>(style.intensityRange.max));
        CHECK(static_cast<float>(style.elevationRange.min) < static_cast<float>(style.elevationRange.max));
    }
}
