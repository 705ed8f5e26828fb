#include "client/measure/pixel_error.hpp"
#include "tests/unit/client/measure/sample_pictures.hpp"

#include <catch2/catch.hpp>

#include <cmath>

using namespace stipple;
using namespace stipple::test;
using measure::pixelError;

TEST_CASE("equal pictures are 0 apart, a negative as far as levels go") {
    auto same = pixelError(samplePicture("base"), samplePicture("base"));
    CHECK(same.mean == 0);
    CHECK(same.rms == 0);
    CHECK(same.largest == 0);
    CHECK(same.differing == 0);
    auto negative = pixelError(constantPicture({0, 0, 0}), constantPicture({255, 255, 255}));
    CHECK(negative.mean == 255);
    CHECK(negative.rms == Approx(255));
    CHECK(negative.largest == 255);
    CHECK(negative.differing == 32 * 24);
}

TEST_CASE("the mean pixel error is that of UnityPIC's equation 6") {
    // 10, 20 and 60 levels in the three channels of a quarter of the pixels.
    Image a = constantPicture({100, 100, 100}, 4, 4), b = a;
    for (std::size_t pixel = 0; pixel < 4; ++pixel) {
        b.rgba[4 * pixel] = 110;
        b.rgba[4 * pixel + 1] = 80;
        b.rgba[4 * pixel + 2] = 160;
    }
    auto error = pixelError(a, b);
    CHECK(error.mean == Approx((10 + 20 + 60) / 3.0 / 4));
    CHECK(error.rms == Approx(std::sqrt((100 + 400 + 3600) / 3.0 / 4)));
    CHECK(error.largest == 60);
    CHECK(error.differing == 4);
    CHECK(pixelError(a, b, 60).differing == 0);
    auto back = pixelError(b, a);
    CHECK(back.mean == error.mean);
    CHECK(back.rms == error.rms);
}
