#include "tests/support/small_cloud.hpp"

#include "shared/format/cloud_file.hpp"
#include "shared/format/cloud_writer.hpp"
#include "shared/format/picture_attributes.hpp"
#include "shared/io/memory_source.hpp"

#include <catch2/catch.hpp>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace stipple::test {

namespace {

CloudMetadata metadataOf(const SmallCloudOptions& options) {
    CloudMetadata metadata;
    metadata.name = "small";
    metadata.grid = options.grid;
    metadata.rootCube = options.rootCube;
    metadata.spacing = 1;
    metadata.pictureColour = options.colour;
    metadata.innerColour = options.innerColour;
    auto add = [&](std::string_view name, AttributeType type = AttributeType::u16) {
        Attribute attribute;
        attribute.name = std::string(name);
        attribute.type = type;
        metadata.schema.attributes.push_back(attribute);
        metadata.statistics.push_back({0, 65535, 32768, 10000, {}});
    };
    if (options.withIntensity || options.colour == PictureColour::intensity)
        add(attribute_names::intensity);
    add(attribute_names::pointSourceId);
    if (options.colour == PictureColour::rgb)
        for (std::string_view name : {attribute_names::red, attribute_names::green, attribute_names::blue})
            add(name);
    if (options.withClasses)
        add(attribute_names::classification, AttributeType::u8);
    if (options.withNormals)
        for (std::string_view name : {"nx", "ny", "nz"})
            add(name, AttributeType::i16);
    return metadata;
}

std::vector<NodeKey> keysOf(int levels) {
    std::vector<NodeKey> keys{NodeKey{}};
    for (std::size_t i = 0; i < keys.size(); ++i)
        for (int child = 0; child < 4 && keys[i].level + 1 < levels; ++child)
            keys.push_back(keys[i].child(child));
    return keys;
}

PointBatch pointsOf(const CloudMetadata& metadata, const NodeKey& key, std::uint32_t count,
                    std::mt19937_64& random) {
    PointBatch points;
    points.resize(metadata.schema, count);
    Vec3i corner = metadata.rootCube.nodeMin(key);
    int bits = metadata.rootCube.nodeBits(key.level);
    if (bits > maxNodeBits)
        points.resize(metadata.schema, 0);
    for (Vec3i& p : points.positions)
        for (int axis = 0; axis < 3; ++axis)
            p[axis] = corner[axis] + static_cast<std::int64_t>(random() & ((1ull << bits) - 1));
    for (Bytes& column : points.columns)
        for (std::uint8_t& byte : column)
            byte = static_cast<std::uint8_t>(random());
    return points;
}

// As many colours as the points have, others than theirs.
std::vector<std::uint16_t> shownOf(const PointBatch& points, std::size_t channels, std::mt19937_64& random) {
    std::vector<std::uint16_t> shown(channels * points.size());
    for (std::uint16_t& value : shown)
        value = static_cast<std::uint16_t>(random());
    return shown;
}

template <class T>
T need(Result<T> result) {
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(*result);
}

} // namespace

SmallCloud makeSmallCloud(const SmallCloudOptions& options) {
    static int made = 0;
    SmallCloud cloud;
    cloud.metadata = metadataOf(options);
    std::mt19937_64 random(options.seed);
    std::string path =
        (std::filesystem::temp_directory_path() /
         ("stipple_small_" + std::to_string(std::random_device{}()) + "_" + std::to_string(++made)))
            .string();
    auto writer = need(CloudWriter::create(path));
    for (const NodeKey& key : keysOf(options.levels)) {
        PointBatch points = pointsOf(cloud.metadata, key, options.pointsPerNode, random);
        for (const Vec3i& p : points.positions)
            cloud.metadata.bounds.extend(p);
        cloud.metadata.pointCount += points.size();
        bool isInner = key.level + 1 < options.levels;
        std::vector<std::uint16_t> shown;
        if (isInner && options.innerColour == InnerColour::mean)
            shown = shownOf(points, pictureAttributes(cloud.metadata).size(), random);
        if (points.size() > 0)
            REQUIRE(writer->add(need(encodeNode(cloud.metadata, key, points, shown))).ok());
    }
    need(writer->finish(cloud.metadata));
    std::ifstream in(path, std::ios::binary);
    cloud.file.assign(std::istreambuf_iterator<char>(in), {});
    in.close();
    std::remove(path.c_str());

    MemorySource source(cloud.file);
    auto reader = need(CloudReader::open(source));
    Status visited = reader->visitNodes([&](const NodeEntry& entry) {
        cloud.nodes.push_back(entry);
        return Status();
    });
    REQUIRE(visited.ok());
    return cloud;
}

} // namespace stipple::test
