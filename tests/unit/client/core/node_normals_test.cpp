#include "client/core/node_normals.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <limits>
#include <random>

using namespace stipple;

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Between two directions; for small angles, too.
double angleBetween(Vec3d a, Vec3d b) {
    return std::atan2(length(cross(a, b)), dot(a, b));
}

double errorOf(Vec3d normal) {
    Vec3<std::int32_t> whole = normalOfWord(normalWord(normal));
    CHECK(std::abs(whole.x) + std::abs(whole.y) + std::abs(whole.z) == 32767);
    return angleBetween(normal, {double(whole.x), double(whole.y), double(whole.z)});
}

Schema schemaOf(std::vector<std::string> names) {
    Schema schema;
    for (std::string& name : names)
        schema.attributes.push_back({std::move(name), AttributeType::f32});
    return schema;
}

template <class T>
std::shared_ptr<const NodeColumns> column(int attribute, const std::vector<T>& values) {
    ByteWriter bytes;
    for (T value : values)
        bytes.write(value);
    return std::make_shared<NodeColumns>(
        NodeColumns{static_cast<std::uint32_t>(values.size()), {{attribute, sizeof(T)}}, bytes.take()});
}

} // namespace

TEST_CASE("a normal's word is off by at most the angle that is stated", "[numerics]") {
    std::mt19937_64 random(1);
    std::normal_distribution<double> any;
    double worst = 0;
    for (int i = 0; i < 200000; ++i)
        worst = std::max(worst, errorOf({any(random), any(random), any(random)}));
    // Edges and corners of the octahedron, where it is unfolded, and next to them.
    for (double x : {-1.0, -1e-9, 0.0, 1e-9, 1.0})
        for (double y : {-1.0, -1e-5, 0.0, 1e-5, 1.0})
            for (double z : {-1.0, -1e-7, 0.0, 1e-7, 1.0})
                if (x != 0 || y != 0 || z != 0)
                    worst = std::max(worst, errorOf({x, y, z}));
    std::printf("normals: off by at most %.2g radians\n", worst);
    CHECK(worst < normalWordError);
    CHECK(worst > normalWordError / 4); // the bound says something
}

TEST_CASE("a normal's length makes no difference, and one without a direction has a word of its own") {
    for (double length : {1e-300, 1e-10, 1.0, 1e10, 1e300, 1.7e308})
        CHECK(normalWord(Vec3d{1, -2, 0.5} * (length / 2)) == normalWord({1, -2, 0.5}));
    for (Vec3d none : {Vec3d{}, Vec3d{std::nan(""), 0, 1}, Vec3d{0, infinity, 0}, Vec3d{1, 0, -infinity}})
        CHECK(normalWord(none) == noNormalWord);
    CHECK(normalWord({0, 0, -1}) != noNormalWord);
}

TEST_CASE("a cloud has normals under the names that files give them") {
    using Found = std::optional<std::array<int, 3>>;
    CHECK(normalAttributes(schemaOf({"Intensity", "nx", "ny", "nz"})) == Found{{1, 2, 3}});          // PLY
    CHECK(normalAttributes(schemaOf({"NormalZ", "NormalX", "Red", "NormalY"})) == Found{{1, 3, 0}}); // LAS
    CHECK(normalAttributes(schemaOf({"normal_x", "normal_y", "normal_z", "curvature"})) ==
          Found{{0, 1, 2}}); // PCD
    CHECK(normalAttributes(schemaOf({"nor:normalX", "nor:normalY", "nor:normalZ"})) ==
          Found{{0, 1, 2}}); // E57
    CHECK_FALSE(normalAttributes(schemaOf({"nx", "ny"})));
    CHECK_FALSE(normalAttributes(schemaOf({"nx", "NormalY", "nz"})));
    CHECK_FALSE(normalAttributes({}));
}

TEST_CASE("normals of a node are packed from its blocks, whatever their type") {
    Schema schema = schemaOf({"nx", "ny", "nz"});
    schema.attributes[1].type = AttributeType::i8;
    schema.attributes[1].scale = 1.0 / 127;
    schema.attributes[2].noData = -9;
    std::vector columns{column<float>(0, {0, 1, 0}), column<std::int8_t>(1, {127, 127, 0}),
                        column<float>(2, {0, 1, -9})};
    auto normals = packNormals(schema, columns);
    REQUIRE(normals);
    CHECK(normals->id != 0);
    CHECK(normals->words ==
          std::vector<std::uint32_t>{normalWord({0, 1, 0}), normalWord({1, 1, 1}), noNormalWord});
    columns.pop_back();
    CHECK_FALSE(packNormals(schema, columns));
    CHECK_FALSE(packNormals({}, columns));
}
