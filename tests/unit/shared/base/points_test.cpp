// Attributes, schemas and batches.
#include "shared/points/attribute.hpp"
#include "shared/points/point_batch.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

TEST_CASE("every attribute type has a name and a size, and is found by its name") {
    const std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};
    for (int i = 0; i < 10; ++i) {
        auto type = static_cast<AttributeType>(i);
        CHECK(attributeTypeSize(type) == sizes[i]);
        CHECK(attributeTypeFromName(attributeTypeName(type)) == type);
    }
    CHECK(std::string(attributeTypeName(AttributeType::i16)) == "int16");
    CHECK(!attributeTypeFromName("short"));
    CHECK(!attributeTypeFromName(""));
}

TEST_CASE("a schema finds attributes and sums their bytes") {
    Schema schema{{{"a", AttributeType::u16}, {"b", AttributeType::f64, 3}}};
    CHECK(schema.find("b") == 1);
    CHECK(schema.find("B") == -1);
    CHECK(schema.attributes[1].size() == 24);
    CHECK(schema.bytesPerPoint() == 26);
    CHECK(Schema{}.bytesPerPoint() == 0);
}

TEST_CASE("a batch sizes its columns, with zeros for new points") {
    Schema schema{{{"a", AttributeType::u16}, {"b", AttributeType::f64, 3}}};
    PointBatch batch;
    batch.resize(schema, 3);
    CHECK(batch.size() == 3);
    CHECK(batch.columns[0].size() == 6);
    CHECK(batch.columns[1].size() == 72);
    batch.setValue<std::uint16_t>(0, 2, 65535);
    batch.resize(schema, 4);
    CHECK(batch.value<std::uint16_t>(0, 2) == 65535);
    CHECK(batch.value<std::uint16_t>(0, 3) == 0);
    CHECK(batch.positions[3] == Vec3i{});
}
