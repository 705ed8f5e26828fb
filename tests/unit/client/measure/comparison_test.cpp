#include "client/measure/comparison.hpp"
#include "client/measure/flip.hpp"
#include "client/measure/ssim.hpp"
#include "tests/unit/client/measure/sample_pictures.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;
using measure::compare;

namespace {

DepthImage pictureOf(const std::string& name, float distance) {
    Image image = samplePicture(name);
    std::vector<float> distances(image.rgba.size() / 4, distance);
    return {std::move(image), std::move(distances)};
}

} // namespace

TEST_CASE("a comparison holds every measure") {
    DepthImage base = pictureOf("base", 10), noise = pictureOf("noise", 11);
    auto result = compare(base, noise);
    REQUIRE(result.ok());
    CHECK(result->pixels.mean == measure::pixelError(base.image, noise.image).mean);
    CHECK(result->ssim == measure::ssim(base.image, noise.image));
    CHECK(result->flip == measure::mean(measure::flip(base.image, noise.image)));
    CHECK(result->depth.wrongShare == 1);
    auto same = compare(base, base);
    REQUIRE(same.ok());
    CHECK(same->pixels.largest == 0);
    CHECK(same->ssim == Approx(1));
    CHECK(same->flip == 0);
    CHECK(same->depth.wrong == 0);
}

TEST_CASE("pictures of different sizes, and ones too small for a window, are refused") {
    DepthImage base = pictureOf("base", 10);
    DepthImage other{constantPicture({1, 2, 3}, 96, 71), std::vector<float>(96 * 71)};
    DepthImage withoutDepth{samplePicture("base"), {}};
    DepthImage small{constantPicture({1, 2, 3}, 40, 10), std::vector<float>(400)};
    DepthImage nothing;
    CHECK(compare(base, other).error().code == ErrorCode::invalidArgument);
    CHECK(compare(base, withoutDepth).error().code == ErrorCode::invalidArgument);
    CHECK(compare(small, small).error().code == ErrorCode::invalidArgument);
    CHECK(compare(nothing, nothing).error().code == ErrorCode::invalidArgument);
}

TEST_CASE("a difference picture is grey where pictures agree") {
    Image a = constantPicture({100, 100, 100}, 2, 1), b = a;
    b.rgba[0] = 110;
    b.rgba[1] = 0;
    Image difference = measure::differencePicture(a, b);
    CHECK(difference.rgba[0] == 148);
    CHECK(difference.rgba[1] == 0);
    CHECK(difference.rgba[2] == 128);
    CHECK(difference.rgba[3] == 255);
    CHECK(difference.rgba[4] == 128);
}
