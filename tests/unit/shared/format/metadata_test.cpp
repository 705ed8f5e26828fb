#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"
#include "tests/unit/shared/format/sample_cloud.hpp"

#include <cmath>
#include <limits>

using namespace stipple;
using namespace stipple::test;

namespace {

CloudMetadata fullMetadata() {
    CloudMetadata metadata = sampleMetadata();
    metadata.crs = {"WGS 84 / UTM zone 32N",
                    "PROJCRS[\"quoted \\ text\"]",
                    32632,
                    "+proj=utm +zone=32",
                    "metre",
                    1.0,
                    "DHHN2016 height",
                    {{"Easting", "east", "metre", 1}, {"Latitude", "north", "degree", 0}}};
    metadata.grid = {{0.001, 0.1, 1.0 / 3.0}, {5e-324, -123456789.123456789, 1e300}};
    metadata.rootCube.min = {INT64_MIN / 4, 7, -9007199254740993};
    metadata.bounds = {{-5, -6, -7}, {1, 2, INT64_MAX}};
    metadata.pointCount = 1000000000000;
    metadata.colourIs8Bit = true;
    metadata.innerColour = InnerColour::mean;
    metadata.schema.attributes[0].noData = -1.5;
    metadata.schema.attributes[1].scale = 0.006;
    metadata.statistics[0] = {0.1, 0.2, 0.3, 0.4, {{-5, 7}, {200, UINT64_MAX}}};
    metadata.pointHash = "0123456789abcdef0123456789abcdef";
    metadata.sources = {{"täst.las", "LAS 1.2, point format 2", 17, UINT64_MAX},
                        {"b.las", "LAS 1.2, point format 2", 17, 5, "0123456789abcdef0123456789abcdef"}};
    metadata.tool = "stipple 0.1.0";
    return metadata;
}

std::string textOf(const Bytes& block) {
    return {block.begin() + blockFrameBytes, block.end()};
}
Bytes framed(const std::string& text) {
    return frameBlock(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

} // namespace

TEST_CASE("metadata come back, every double to its last bit") {
    CloudMetadata metadata = fullMetadata();
    CloudMetadata read = need(parseMetadata(writeMetadata(metadata)));
    CHECK(read.name == metadata.name);
    CHECK(read.crs == metadata.crs);
    CHECK(read.grid == metadata.grid);
    CHECK(read.rootCube == metadata.rootCube);
    CHECK(read.spacing == metadata.spacing);
    CHECK(read.sampling == Sampling::poisson);
    CHECK(read.bounds == metadata.bounds);
    CHECK(read.pointCount == metadata.pointCount);
    CHECK(read.schema == metadata.schema);
    CHECK(read.statistics == metadata.statistics);
    CHECK(read.pictureColour == metadata.pictureColour);
    CHECK(read.colourIs8Bit);
    CHECK(read.innerColour == InnerColour::mean);
    CHECK(read.pointHash == metadata.pointHash);
    CHECK(read.sources == metadata.sources);
    CHECK(read.tool == metadata.tool);
}

TEST_CASE("vertical system and axes may be absent") {
    CloudMetadata metadata = fullMetadata();
    metadata.crs.vertical.clear();
    metadata.crs.axes.clear();
    Bytes block = writeMetadata(metadata);
    CHECK(textOf(block).find("axes") == std::string::npos);
    CHECK(textOf(block).find("vertical") == std::string::npos);
    CHECK(need(parseMetadata(block)).crs == metadata.crs);
}

TEST_CASE("the sampling is poisson unless another is named") {
    CloudMetadata metadata = fullMetadata();
    CHECK(textOf(writeMetadata(metadata)).find("sampling") == std::string::npos);
    for (Sampling sampling : {Sampling::random, Sampling::grid}) {
        metadata.sampling = sampling;
        CHECK(need(parseMetadata(writeMetadata(metadata))).sampling == sampling);
    }
    std::string text = textOf(writeMetadata(metadata));
    text.replace(text.find("\"grid\"", text.find("sampling")), 6, "\"gird\"");
    auto read = parseMetadata(framed(text));
    REQUIRE_FALSE(read.ok());
    CHECK(read.error().what == "\"sampling\" is not poisson, random or grid");
}

TEST_CASE("inner nodes show their own colours unless metadata say otherwise") {
    CloudMetadata metadata = sampleMetadata();
    std::string text = textOf(writeMetadata(metadata));
    CHECK(text.find("innerColour") == std::string::npos);
    CHECK(need(parseMetadata(framed(text))).innerColour == InnerColour::exact);
    metadata.innerColour = InnerColour::mean;
    metadata.pictureColour = PictureColour::none;
    auto read = parseMetadata(writeMetadata(metadata));
    REQUIRE_FALSE(read.ok());
    CHECK(read.error().what == "\"innerColour\" is not exact, although there is no colour");
}

TEST_CASE("statistics that are no finite number come back") {
    CloudMetadata metadata = fullMetadata();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    metadata.statistics[4] = {-infinity, infinity, std::nan(""), 0, {}};
    AttributeStatistics read = need(parseMetadata(writeMetadata(metadata))).statistics[4];
    CHECK(read.min == -infinity);
    CHECK(read.max == infinity);
    CHECK(std::isnan(read.mean));
}

TEST_CASE("a missing field is named") {
    std::string text = textOf(writeMetadata(fullMetadata()));
    for (const char* field :
         {"name", "pointCount", "wkt", "scale", "bits", "spacing", "pictureColour", "attributes",
          "components", "histogram", "pointHash", "sources", "sizeBytes", "tool", "options"}) {
        std::string changed = text, quoted = std::string("\"") + field + "\":";
        std::size_t at = changed.find(quoted);
        REQUIRE(at != std::string::npos);
        changed[at + 1] = '#';
        auto read = parseMetadata(framed(changed));
        REQUIRE(!read.ok());
        INFO(read.error().sentence());
        CHECK(read.error().what.find(field) != std::string::npos);
    }
}

TEST_CASE("fields that contradict each other are refused") {
    auto refused = [](auto change) {
        CloudMetadata metadata = fullMetadata();
        change(metadata);
        return !parseMetadata(writeMetadata(metadata)).ok();
    };
    CHECK(refused([](CloudMetadata& m) { m.grid.scale.y = 0; }));
    CHECK(refused([](CloudMetadata& m) { m.grid.scale.z = std::nan(""); }));
    CHECK(refused([](CloudMetadata& m) { m.rootCube.bits = 53; }));
    CHECK(refused([](CloudMetadata& m) { m.rootCube.min.x = INT64_MAX; }));
    CHECK(refused([](CloudMetadata& m) { m.schema.attributes[5].type = AttributeType::u8; }));
    CHECK(refused([](CloudMetadata& m) { m.schema.attributes[1].name = m.schema.attributes[0].name; }));
    CHECK(refused([](CloudMetadata& m) { m.schema.attributes[1].components = 256; }));
}

TEST_CASE("altered metadata are errors or other metadata") {
    std::string text = textOf(writeMetadata(fullMetadata()));
    std::mt19937 random(3);
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        std::string changed = text;
        changed[random() % changed.size()] = static_cast<char>(random());
        if (i % 3 == 0)
            changed.resize(random() % changed.size());
        refused += !parseMetadata(framed(changed)).ok();
    }
    CHECK(refused > 1000);
}
