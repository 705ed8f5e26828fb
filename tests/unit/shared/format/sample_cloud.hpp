// Small clouds made from a seed, for tests of the file and its nodes.
#pragma once

#include "shared/base/result.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/point_hash.hpp"

#include <catch2/catch.hpp>

#include <random>
#include <string>

namespace stipple::test {

// The value, or a failed test with the error's sentence.
template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(result).value();
}
inline void need(const Status& status) {
    if (!status.ok())
        FAIL(status.error().sentence());
}

inline Attribute attributeOf(std::string name, AttributeType type, int components = 1) {
    Attribute attribute;
    attribute.name = std::move(name);
    attribute.type = type;
    attribute.components = components;
    return attribute;
}

// RGB in the picture; further attributes of every type.
inline CloudMetadata sampleMetadata() {
    CloudMetadata metadata;
    metadata.name = "sample";
    metadata.rootCube = {{-1000, 500, 0}, 20};
    metadata.spacing = 1.5;
    metadata.pictureColour = PictureColour::rgb;
    namespace names = attribute_names;
    auto& attributes = metadata.schema.attributes;
    attributes = {attributeOf(std::string(names::intensity), AttributeType::u16),
                  attributeOf(std::string(names::returnNumber), AttributeType::u8),
                  attributeOf(std::string(names::numberOfReturns), AttributeType::u8),
                  attributeOf(std::string(names::userData), AttributeType::u8),
                  attributeOf(std::string(names::gpsTime), AttributeType::f64),
                  attributeOf(std::string(names::red), AttributeType::u16),
                  attributeOf(std::string(names::green), AttributeType::u16),
                  attributeOf(std::string(names::blue), AttributeType::u16)};
    int i = 0;
    for (auto type : {AttributeType::i8, AttributeType::i16, AttributeType::u32, AttributeType::i32,
                      AttributeType::u64, AttributeType::i64, AttributeType::f32})
        attributes.push_back(attributeOf("extra " + std::to_string(i++), type));
    attributes.push_back(attributeOf("tuple", AttributeType::i16, 3));
    metadata.statistics.resize(attributes.size());
    return metadata;
}

// `count` points in node `key`, all but "User Data" (zero) random.
inline PointBatch randomPoints(const CloudMetadata& metadata, NodeKey key, std::size_t count,
                               std::uint32_t seed) {
    std::mt19937_64 random(seed);
    PointBatch points;
    points.resize(metadata.schema, count);
    Vec3i corner = metadata.rootCube.nodeMin(key);
    std::uint64_t mask = (std::uint64_t{1} << metadata.rootCube.nodeBits(key.level)) - 1;
    for (auto& p : points.positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = corner[axis] + static_cast<std::int64_t>(random() & mask);
    for (std::size_t a = 0; a < points.columns.size(); ++a)
        if (metadata.schema.attributes[a].name != attribute_names::userData)
            for (std::uint8_t& byte : points.columns[a])
                byte = static_cast<std::uint8_t>(random());
    return points;
}

inline PointHash hashOf(const CloudMetadata& metadata, const PointBatch& points) {
    PointHash hash;
    hash.add(metadata.schema, points);
    return hash;
}

} // namespace stipple::test
