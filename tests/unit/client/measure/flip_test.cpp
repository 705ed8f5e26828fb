#include "client/measure/flip.hpp"
#include "client/measure/flip_filters.hpp"
#include "tests/unit/client/measure/sample_pictures.hpp"

#include <catch2/catch.hpp>

#include <numeric>

using namespace stipple;
using namespace stipple::test;
using measure::flip;
using measure::mean;

namespace {

Rgb rgbOf(const nlohmann::json& value) {
    return {value[0].get<int>(), value[1].get<int>(), value[2].get<int>()};
}

double sum(const measure::Kernel& kernel) {
    return std::accumulate(kernel.begin(), kernel.end(), 0.0);
}

} // namespace

TEST_CASE("FLIP is what its authors' algorithm gives") {
    Image base = samplePicture("base");
    nlohmann::json pairs = oracleMeasures().at("pairs");
    REQUIRE(pairs.size() == 4);
    for (const auto& [name, values] : pairs.items()) {
        INFO(name);
        CHECK(mean(flip(base, samplePicture(name))) == Approx(values.at("flip").get<double>()).margin(2e-6));
    }
}

TEST_CASE("FLIP of constant pictures is what its authors' algorithm gives, at every pixel") {
    for (const auto& pair : oracleMeasures().at("constants")) {
        INFO(pair);
        auto errors = flip(constantPicture(rgbOf(pair.at("a"))), constantPicture(rgbOf(pair.at("b"))));
        REQUIRE(errors.values.size() == 32 * 24);
        for (float error : errors.values)
            CHECK(error == Approx(pair.at("flip").get<double>()).margin(2e-6));
    }
}

TEST_CASE("FLIP is symmetric, 0 for equal pictures and never beyond 1") {
    Image base = samplePicture("base"), dots = samplePicture("dots");
    CHECK(mean(flip(base, base)) == 0);
    auto there = flip(base, dots), back = flip(dots, base);
    for (std::size_t i = 0; i < there.values.size(); ++i) {
        REQUIRE(there.values[i] == Approx(back.values[i]).margin(1e-6));
        REQUIRE(there.values[i] >= 0);
        REQUIRE(there.values[i] <= 1);
    }
    // Noise that is looked at from farther away is seen less.
    Image noise = samplePicture("noise");
    CHECK(mean(flip(base, noise, 2 * measure::flipPixelsPerDegree)) < mean(flip(base, noise)));
}

TEST_CASE("FLIP reaches beyond a changed pixel as far as the eye blurs it") {
    Image a = constantPicture({90, 120, 60}, 64, 64), b = a;
    std::size_t pixel = 4 * (32 * 64 + 32);
    b.rgba[pixel] = b.rgba[pixel + 1] = b.rgba[pixel + 2] = 255;
    auto errors = flip(a, b);
    CHECK(errors.row(32)[32] > 0.1);
    CHECK(errors.row(32)[34] > 0);
    CHECK(errors.row(32)[32] == *std::max_element(errors.values.begin(), errors.values.end()));
    CHECK(errors.row(32)[2] == 0);
    CHECK(errors.row(60)[32] == 0);
}

TEST_CASE("the filters of FLIP are normalised and as wide as the paper says") {
    auto achromatic = measure::sensitivityFilter(measure::achromatic, measure::flipPixelsPerDegree);
    auto blueYellow = measure::sensitivityFilter(measure::blueYellow, measure::flipPixelsPerDegree);
    REQUIRE(achromatic.size() == 1);
    REQUIRE(blueYellow.size() == 2);
    CHECK(achromatic[0].kernel.size() == 21);
    CHECK(blueYellow[0].weight + blueYellow[1].weight == Approx(1));
    for (const auto& term : blueYellow)
        CHECK(sum(term.kernel) == Approx(1));
    auto feature = measure::featureFilter(measure::flipPixelsPerDegree);
    CHECK(feature.edge.size() == 19);
    CHECK(sum(feature.gaussian) == Approx(1));
    CHECK(sum(feature.edge) == Approx(0).margin(1e-6));
    CHECK(sum(feature.point) == Approx(0).margin(1e-6));
}

TEST_CASE("an error picture goes from black to pale yellow") {
    measure::Plane<float> errors(3, 1);
    errors.values = {0, 0.5f, 1};
    Image image = measure::errorPicture(errors);
    REQUIRE(image.rgba.size() == 12);
    CHECK(image.rgba[0] + image.rgba[1] + image.rgba[2] < 10);
    CHECK(image.rgba[8] + image.rgba[9] > 480);
    CHECK(image.rgba[4] > image.rgba[5]);
}
