#include "client/core/json.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <limits>

using namespace stipple;

namespace {

Style styleOf(const std::string& text, const Style& base = {}) {
    auto style = styleFromJson(text, base);
    INFO((style.ok() ? std::string() : style.error().sentence()));
    REQUIRE(style.ok());
    return *style;
}

std::string refusalOf(const std::string& text) {
    auto style = styleFromJson(text);
    return style.ok() ? "accepted" : style.error().sentence();
}

} // namespace

TEST_CASE("colours, filters and clip boxes come back from JSON as they were") {
    Style style;
    style.colourMode = ColourMode::mix;
    style.gradient = GradientName::inferno;
    style.attribute = "Amplitude";
    style.attributeRange = {-2, 7.5};
    style.levelRange = {0, 9};
    style.mix = {{ColourMode::rgb, "", {}, 2}, {ColourMode::attribute, "NIR", {0, 100}, 0.25}};
    style.hiddenClasses.set(0).set(18).set(255);
    style.filters = {{"Return Number", 1, 1}, {"GPS Time", 3.5e8, std::numeric_limits<double>::infinity()}};
    style.clipBoxes = {{{1, 2, 3}, {4, 5, 6}, *axesOfQuaternion(0.1, -0.2, 0.3, 0.4), ClipMode::highlight}};
    style.clipRegions.resize(3);
    style.clipRegions[0].shape.rings = {{{0.1, 1}, {9, 0}, {0, 9}}, {{1, 1}, {2, 1}, {1, 2}}};
    style.clipRegions[0].shape.heights = ValueRange{-std::numeric_limits<double>::infinity(), 0.3};
    style.clipRegions[1] = {{}, ClipMode::highlight};
    style.clipRegions[1].shape.line = {{1, 2}, {3, 4.1}};
    style.clipRegions[1].shape.width = 0.7;
    style.clipRegions[2] = {{}, ClipMode::hideInside};
    style.clipRegions[2].shape.prism =
        ScreenPolygon{Vec3d{0, 0, 10}, {0, 0, -1}, {{-1, -1, 5}, {1, -1, 5}, {0, 1, 5}}};
    style.highlight = {1, 2, 3};
    CHECK(styleOf(toJson(style).dump()) == style);
    CHECK(styleOf("{}", style) == style);
}

TEST_CASE("lists replace what was there, as a whole") {
    Style base = styleOf(R"({"hiddenClasses": [1, 2], "filters": [{"attribute": "a", "min": 1}],
                             "clipBoxes": [{"halfSize": [1, 1, 1]}]})");
    CHECK(base.hiddenClasses.count() == 2);
    Style next = styleOf(R"({"hiddenClasses": [7], "filters": [], "clipBoxes": []})", base);
    CHECK(next.hiddenClasses.count() == 1);
    CHECK(next.hiddenClasses[7]);
    CHECK(next.filters.empty());
    CHECK(next.clipBoxes.empty());
}

TEST_CASE("a box is turned by a quaternion or by axes") {
    Style style = styleOf(R"({"clipBoxes": [{"centre": [9, 9, 9], "rotation": [0, 0, 1, 1]},
                              {"axes": [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], "mode": "hideInside"}]})");
    REQUIRE(style.clipBoxes.size() == 2);
    CHECK(style.clipBoxes[0].axes[0].y == Approx(1));
    CHECK(style.clipBoxes[0].halfSize == Vec3d{1, 1, 1});
    CHECK(style.clipBoxes[0].mode == ClipMode::hideOutside);
    CHECK(style.clipBoxes[1].axes[1].x == -1);
    CHECK(style.clipBoxes[1].mode == ClipMode::hideInside);
}

TEST_CASE("what is wrong with colours is said, and where") {
    auto says = [](const std::string& text, const std::string& part) {
        INFO(refusalOf(text));
        CHECK(refusalOf(text).find(part) != std::string::npos);
    };
    says(R"({"colourMode": "attribute"})", "'attribute' must name the attribute");
    says(R"({"colourMode": "mix"})", "must name the colours to mix");
    says(R"({"mix": [{"colourMode": "mix"}]})", "style.mix[0]");
    says(R"({"mix": [{"weight": 0}]})", "'weight'");
    says(R"({"mix": [{"colourMode": "attribute"}]})", "must name the attribute");
    says(R"({"hiddenClasses": [3, 256]})", "style.hiddenClasses[1]");
    says(R"({"hiddenClasses": 3})", "must be a list");
    says(R"({"filters": [{"min": 1}]})", "'attribute' must name an attribute");
    says(R"({"filters": [{"attribute": "a", "min": 2, "max": 1}]})", "must not exceed max");
    says(R"({"filters": [{"attribute": "a", "least": 2}]})", "there is no field 'least'");
    says(R"({"clipBoxes": [{"halfSize": [1, -1, 1]}]})", "must not be negative");
    says(R"({"clipBoxes": [{"rotation": [0, 0, 0, 0]}]})", "must not be zero");
    says(R"({"clipBoxes": [{"rotation": [0, 0, 1]}]})", "must be 4 numbers");
    says(R"({"clipBoxes": [{"axes": [[1, 0, 0], [0, 1, 0]]}]})", "right angles");
    says(R"({"clipBoxes": [{"axes": [[1, 0, 0], [1, 0, 0], [0, 0, 1]]}]})", "right angles");
    says(R"({"clipBoxes": [{"axes": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "rotation": [0, 0, 0, 1]}]})",
         "beside a rotation");
    says(R"({"clipBoxes": [{"mode": "cut"}]})", "highlight, hideInside, hideOutside");
    says(R"({"clipBoxes": [7]})", "an object");
    says(R"({"clipRegions": [{}]})", "'region' must be given");
    says(R"({"clipRegions": [{"region": {}}]})", "'region' must be given");
    says(R"({"clipRegions": [{"region": {"polygon": [[0, 0], [1, 1]]}}]})",
         "style.clipRegions[0].region.polygon: each of its rings must have three corners");
    says(R"({"clipRegions": [{"region": {"circle": 1}}]})", "no field 'circle'");
    says(R"({"clipRegions": [{"mode": "cut", "region": {"heights": [0, 1]}}]})", "highlight, hideInside");
    says(
        R"({"clipRegions": [{"region": {"prism": {"corners": [[0, 0, 0], [1, 0, 1], [1, 0, 0], [0, 0, 2]]}}}]})",
        "the polygon's edges cross");
    says(
        R"({"clipRegions": [{"region": {"prism": {"corners": [[0, 0, 0], [1, 0, 0], [1, 0, 1], [0.5, 0, 0]]}}}]})",
        "the polygon's edges cross");
    std::string corners = "[0, 0]";
    for (int i = 1; i <= 6000; ++i)
        corners += ", [" + std::to_string(i) + ", " + std::to_string(i % 7) + "]";
    std::string large = "{\"region\": {\"polygon\": [" + corners + "]}}";
    says(("{\"clipRegions\": [" + large + "]}").c_str(), "accepted");
    says(("{\"clipRegions\": [" + large + ", " + large + "]}").c_str(), "may have 10000 corners together");
}
