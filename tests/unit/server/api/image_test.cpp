#include "client/headless/png.hpp"
#include "server/api/image_request.hpp"
#include "server/api/picture_service.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>
#include <webp/decode.h>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

namespace {

const std::string path = "/api/v1/clouds/small/image";
const std::string tiny = path + "?width=64&height=48";

headless::PictureRequest requestOf(const std::string& query) {
    auto parsed = Query::parse(query);
    REQUIRE(parsed.ok());
    auto request = imageRequestOf(*parsed);
    if (!request)
        FAIL(request.error().sentence());
    return *request;
}

std::string faultOf(const std::string& query) {
    auto parsed = Query::parse(query);
    REQUIRE(parsed.ok());
    auto request = imageRequestOf(*parsed);
    return request ? "none" : request.error().where;
}

// Red, green and blue of each pixel, as other readers find them.
Bytes pixelsOfWebp(const std::string& file) {
    int width = 0, height = 0;
    auto* bytes = reinterpret_cast<const std::uint8_t*>(file.data());
    std::uint8_t* decoded = WebPDecodeRGB(bytes, file.size(), &width, &height);
    REQUIRE(decoded != nullptr);
    Bytes pixels(decoded, decoded + 3 * width * height);
    WebPFree(decoded);
    return pixels;
}
Bytes pixelsOfPng(const std::string& file) {
    TemporaryFolder folder;
    writeText(folder.file("a.png"), file);
    auto image = headless::readPng(folder.file("a.png"));
    REQUIRE(image.ok());
    Bytes pixels;
    for (std::size_t i = 0; i < image->rgba.size(); ++i)
        if (i % 4 != 3)
            pixels.push_back(image->rgba[i]);
    return pixels;
}

} // namespace

TEST_CASE("a picture is a PNG or a WebP of the size asked for") {
    ApiFixture api;
    auto png = api.ask(tiny);
    REQUIRE(png.status == 200);
    CHECK(png.field("Content-Type") == "image/png");
    CHECK(png.field("Vary") == "Accept");
    CHECK(png.body.starts_with("\x89PNG\r\n"));
    CHECK(png.body.substr(16, 8) == std::string("\0\0\0\x40\0\0\0\x30", 8)); // IHDR
    auto webp = api.ask(tiny + "&format=webp");
    CHECK(webp.field("Content-Type") == "image/webp");
    CHECK(webp.body.starts_with("RIFF"));
    CHECK(webp.body.substr(8, 4) == "WEBP");
    CHECK((pixelsOfWebp(webp.body) == pixelsOfPng(png.body)));
    CHECK(api.ask(tiny, {{"Accept", "image/webp,image/*;q=0.8"}}).field("Content-Type") == "image/webp");
    CHECK(api.ask(tiny, {{"Accept", "application/json"}}).status == 406);
}

TEST_CASE("the same request gives the same bytes, drawn anew, warm or kept") {
    ApiFixture first, second;
    std::string cold = first.ask(tiny).body;
    auto other =
        second.ask(path + "?width=80&height=48&view=top"); // its nodes are decoded for the next picture
    REQUIRE(other.status == 200);
    CHECK((second.ask(tiny).body == cold));
    CHECK(second.pictures().sessionsReused() == 1);
    CHECK((second.ask(tiny).body == cold));
    CHECK(second.pictures().counts().misses == 2);
    CHECK(second.pictures().sessionsReused() == 1);
}

TEST_CASE("a picture shows what its parameters say") {
    ApiFixture api;
    std::string usual = api.ask(tiny).body;
    for (auto more :
         {"&view=top", "&view=front", "&projection=orthographic", "&mode=elevation", "&mode=intensity",
          "&pointSize=9", "&pointSize=9&pointShape=square", "&edl=off", "&background=ffffff", "&budget=50",
          "&eye=0,0,400000&target=65000,65000,0", "&mode=elevation&gradient=turbo", "&mode=level",
          "&mode=pointSourceId", R"(&style={"colourMode":"elevation"})",
          R"(&style={"filters":[{"attribute":"Intensity","max":30000}]})",
          R"(&style={"clipBoxes":[{"centre":[65000,65000,65000],"halfSize":[30000,30000,99000]}]})"}) {
        INFO(more);
        auto answer = api.ask(tiny + more);
        CHECK(answer.status == 200);
        CHECK((answer.body != usual));
    }
}

TEST_CASE("a picture's tag is known before it is drawn, and the same however it is asked for") {
    ApiFixture api;
    std::string tag = api.ask(tiny).field("ETag");
    CHECK(api.ask(tiny, {{"If-None-Match", tag}}).status == 304);
    CHECK(api.ask(tiny + "&view=iso&edl=on&mode=rgb&projection=perspective&budget=2000000&background=181A1E")
              .field("ETag") == tag);
    CHECK(api.ask(tiny + "&view=top").field("ETag") != tag);
    CHECK(api.ask(tiny + "&format=webp").field("ETag") != tag);
    ApiFixture fresh;
    auto unseen = fresh.ask(tiny + "&format=png");
    CHECK(fresh.ask(tiny + "&format=png", {{"If-None-Match", unseen.field("ETag")}}).status == 304);
}

TEST_CASE("cameras are read from their parameters") {
    CHECK(requestOf("").view == "iso");
    CHECK(requestOf("").width == 1280);
    CHECK(requestOf("view=front").view == "front");
    CHECK(requestOf("projection=orthographic").projection == Projection::orthographic);
    auto camera = nlohmann::json::parse(requestOf("eye=1,2,3&target=4,5,-6.5&fov=45").view);
    CHECK(camera ==
          nlohmann::json{
              {"position", {1, 2, 3}}, {"target", {4, 5, -6.5}}, {"up", {0, 0, 1}}, {"fovYDegrees", 45}});
    auto flat = nlohmann::json::parse(
        requestOf("eye=1,2,3&target=4,5,6&up=0,1,0&projection=orthographic&orthoHeight=10").view);
    CHECK(flat ==
          nlohmann::json{
              {"position", {1, 2, 3}}, {"target", {4, 5, 6}}, {"up", {0, 1, 0}}, {"orthoHeight", 10}});
}

TEST_CASE("parameters of pictures that can't be are refused by name") {
    CHECK(faultOf("view=back") == "view");
    CHECK(faultOf("view=top&eye=1,2,3&target=1,2,4") == "view");
    CHECK(faultOf("eye=1,2,3") == "target");
    CHECK(faultOf("target=1,2,3") == "eye");
    CHECK(faultOf("fov=30") == "eye");
    CHECK(faultOf("eye=1,2,3&target=1,2,3") == "target");
    CHECK(faultOf("eye=1,2&target=1,2,3") == "eye");
    CHECK(faultOf("eye=1,2,nan&target=1,2,3") == "eye");
    CHECK(faultOf("eye=1,2,1e200&target=1,2,3") == "eye");
    CHECK(faultOf("eye=1,2,3&target=1,2,4&orthoHeight=3") == "orthoHeight");
    CHECK(faultOf("eye=1,2,3&target=1,2,4&projection=orthographic") == "orthoHeight");
    CHECK(faultOf("eye=1,2,3&target=1,2,4&projection=orthographic&orthoHeight=1&fov=3") == "fov");
    CHECK(faultOf("eye=1,2,3&target=1,2,4&fov=180") == "fov");
    CHECK(faultOf("eye=1,2,3&target=1,2,4&projection=orthographic&orthoHeight=0") == "orthoHeight");
    CHECK(faultOf("width=0") == "width");
    CHECK(faultOf("width=8193") == "width");
    CHECK(faultOf("width=8192&height=8192") == "width");
    CHECK(faultOf("height=8192") == "height");
    CHECK(faultOf("mode=colour") == "mode");
    CHECK(faultOf("pointSize=0") == "pointSize");
    for (auto style : {"{", "7", R"({"shape":"star"})", R"({"sizePixels":65})", R"({"maxSizePixels":400})",
                       R"({"minSizePixels":100,"maxSizePixels":200})", R"({"colourMode":"attribute"})",
                       R"({"clipBoxes":[{"rotation":[0,0,0,0]}]})"}) {
        INFO(style);
        CHECK(faultOf(std::string("style=") + style) == "style");
    }
    CHECK(faultOf("edl=1") == "edl");
    CHECK(faultOf("budget=5000001") == "budget");
    for (auto colour : {"fff", "gggggg", "1234567", "-1-1-1", "+1+1+1", "0x0x0x"}) {
        INFO(colour);
        CHECK(faultOf(std::string("background=") + colour) == "background");
    }
}

TEST_CASE("parameters of their own go before the style") {
    Style style = requestOf(R"(style={"colourMode":"gpsTime","gradient":"grey"}&mode=level)").style;
    CHECK(style.colourMode == ColourMode::level);
    CHECK(style.gradient == GradientName::grey);
}

TEST_CASE("every choice of a picture's parameters is one that the renderer knows") {
    for (const Parameter& parameter : imageParameters)
        for (std::string_view choice : parameter.choices) {
            INFO(parameter.name << " " << choice);
            CHECK(faultOf(std::string(parameter.name) + "=" + std::string(choice)) == "none");
        }
}

TEST_CASE("a picture that is stopped ends its drawing and leaves the next one as it is") {
    ApiFixture api;
    PictureService service;
    auto cloud = api.cloudVersion();
    std::atomic<bool> stop{true}, goOn{false};
    auto stopped = service.picture("a", cloud, requestOf("width=64&height=48"), "png", stop);
    REQUIRE_FALSE(stopped.ok());
    CHECK(stopped.error().code == ErrorCode::cancelled);
    auto drawn = service.picture("a", cloud, requestOf("width=64&height=48"), "png", goOn);
    REQUIRE(drawn.ok());
    CHECK((**drawn == api.ask(tiny).body));
}
