#include "converter/build/common_schema.hpp"

#include "shared/las/las_reader.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {
Attribute extra(const std::string& name, AttributeType type, double scale = 1) {
    Attribute attribute;
    attribute.name = name;
    attribute.type = type;
    attribute.scale = scale;
    return attribute;
}
} // namespace

TEST_CASE("a schema that all inputs share is kept", "[schema]") {
    Schema schema{{extra("b", AttributeType::u8), extra("a", AttributeType::u16)}};
    CommonSchema common = commonSchema({schema, schema});
    CHECK(common.schema == schema);
    CHECK(common.sources[1] == std::vector<int>{0, 1});
}

TEST_CASE("the common schema is the union, in the order of LAS", "[schema]") {
    Schema a = las::schemaOf(1), b = las::schemaOf(2);
    a.attributes.push_back(extra("height", AttributeType::f32));
    CommonSchema common = commonSchema({a, b});
    CHECK(common.schema.attributes.size() == b.attributes.size() + 2);
    int time = common.schema.find("GPS Time"), red = common.schema.find("Red"),
        height = common.schema.find("height");
    CHECK(time < red);
    CHECK(red < height);
    CHECK(common.sources[0][static_cast<std::size_t>(red)] == -1);
    CHECK(common.sources[1][static_cast<std::size_t>(time)] == -1);
    CHECK(common.sources[0][static_cast<std::size_t>(height)] == a.find("height"));
    CHECK(commonSchema({b, a}).schema == common.schema);
}

TEST_CASE("one name for two types becomes two attributes", "[schema]") {
    Schema a{{extra("height", AttributeType::f32)}}, b{{extra("height", AttributeType::u16)}};
    CommonSchema common = commonSchema({a, b});
    REQUIRE(common.schema.attributes.size() == 2);
    CHECK(common.schema.find("height (float32)") == common.schema.find("height (uint16)") - 1);
    CHECK(common.sources[0] == std::vector<int>{0, -1});
    CHECK(common.sources[1] == std::vector<int>{-1, 0});
}

TEST_CASE("one name and type with two scales becomes two attributes", "[schema]") {
    Schema a{{extra("height", AttributeType::u16, 0.01)}}, b{{extra("height", AttributeType::u16, 0.1)}};
    CommonSchema common = commonSchema({a, b});
    REQUIRE(common.schema.attributes.size() == 2);
    CHECK(common.schema.find("height (uint16, scale 0.01, offset 0)") >= 0);
    CHECK(common.schema.find("height (uint16, scale 0.1, offset 0)") >= 0);
}
