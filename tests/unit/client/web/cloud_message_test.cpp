#include "client/web/cloud_message.hpp"

#include <catch2/catch.hpp>

using namespace stipple;

namespace {

CloudMetadata sampleCloud() {
    CloudMetadata metadata;
    metadata.rootCube = {{-5, 1ll << 60, 7}, 33};
    metadata.pictureColour = PictureColour::rgb;
    metadata.innerColour = InnerColour::mean;
    metadata.colourIs8Bit = true;
    for (const char* name : {"Red", "Green", "Blue"})
        metadata.schema.attributes.push_back({name, AttributeType::u16});
    metadata.schema.attributes.push_back({"Waveform", AttributeType::f64, 255});
    return metadata;
}

} // namespace

TEST_CASE("a worker hears of a cloud what it decodes by, and no more") {
    CloudMetadata metadata = sampleCloud();
    metadata.crs.wkt = "PROJCS[]";
    auto back = web::decodeCloud(web::encodeCloud(metadata));
    REQUIRE(back.ok());
    CHECK(back->rootCube.min == metadata.rootCube.min);
    CHECK(back->rootCube.bits == 33);
    CHECK(back->pictureColour == PictureColour::rgb);
    CHECK(back->innerColour == InnerColour::mean);
    CHECK(back->colourIs8Bit);
    CHECK(back->schema == metadata.schema);
    CHECK(back->crs.wkt.empty());
}

TEST_CASE("a cloud without attributes is described, too") {
    CHECK(web::decodeCloud(web::encodeCloud({})).ok());
}

TEST_CASE("every cut or lengthened description of a cloud is refused, and one of what no cloud has") {
    Bytes whole = web::encodeCloud(sampleCloud());
    for (std::size_t size = 0; size < whole.size(); ++size)
        CHECK_FALSE(web::decodeCloud(ByteSpan(whole).first(size)).ok());
    Bytes longer = whole;
    longer.push_back(0);
    CHECK_FALSE(web::decodeCloud(longer).ok());
    for (std::size_t at : {28u, 29u, 30u}) { // bits of the cube, the picture's colour, that of inner nodes
        Bytes other = whole;
        other[at] = 200;
        CHECK_FALSE(web::decodeCloud(other).ok());
    }
    CloudMetadata colourless = sampleCloud();
    colourless.schema.attributes[1].name = "Verde";
    CHECK_FALSE(web::decodeCloud(web::encodeCloud(colourless)).ok());
}
