#include "client/measure/ssim.hpp"
#include "tests/unit/client/measure/sample_pictures.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::test;
using measure::ssim;

TEST_CASE("SSIM is what another implementation gives") {
    Image base = samplePicture("base", true);
    nlohmann::json pairs = oracleMeasures().at("pairs");
    REQUIRE(pairs.size() == 4);
    for (const auto& [name, values] : pairs.items()) {
        INFO(name);
        CHECK(ssim(base, samplePicture(name, true)) == Approx(values.at("ssim").get<double>()).margin(1e-9));
    }
}

TEST_CASE("SSIM of constant pictures is its luminance term alone") {
    constexpr double c1 = 2.55 * 2.55;
    for (auto [a, b] : {std::pair{0, 255}, {100, 110}, {7, 7}, {255, 254}}) {
        double expected = (2.0 * a * b + c1) / (1.0 * a * a + 1.0 * b * b + c1);
        CHECK(ssim(constantPicture({a, a, a}), constantPicture({b, b, b})) == Approx(expected).epsilon(1e-9));
    }
}

TEST_CASE("SSIM is symmetric, and 1 for equal pictures only") {
    Image base = samplePicture("base"), noise = samplePicture("noise");
    CHECK(ssim(base, base) == Approx(1).epsilon(1e-12));
    CHECK(ssim(base, noise) == Approx(ssim(noise, base)).epsilon(1e-12));
    CHECK(ssim(base, noise) < 0.9);
}

TEST_CASE("SSIM judges colours by their luma") {
    // Both have luma 0.299 × 100 = 0.587 × v.
    Image red = constantPicture({100, 0, 0}), green = constantPicture({0, 51, 0});
    CHECK(ssim(red, green) == Approx(1).epsilon(1e-3));
    CHECK(ssim(red, constantPicture({0, 0, 100})) < 0.8);
}

TEST_CASE("SSIM takes the windows that lie wholly inside the picture") {
    Image a = constantPicture({50, 50, 50}, 12, 11), b = a;
    // In the two windows of this picture the pixel lies in the row of the middle, 5 from one middle and 6
    // from the other.
    std::size_t pixel = 4 * (5 * 12 + 0);
    for (std::size_t c = 0; c < 3; ++c)
        b.rgba[pixel + c] = 255;
    double one = ssim(constantPicture({50, 50, 50}, 11, 11), [&] {
        Image picture = constantPicture({50, 50, 50}, 11, 11);
        for (std::size_t c = 0; c < 3; ++c)
            picture.rgba[4 * (5 * 11 + 0) + c] = 255;
        return picture;
    }());
    CHECK(one < 1);
    CHECK(ssim(a, b) == Approx((one + 1) / 2).epsilon(1e-12));
}
