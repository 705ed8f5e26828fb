#include "client/measure/depth_error.hpp"

#include <catch2/catch.hpp>

#include <vector>

using stipple::measure::depthError;

TEST_CASE("pixels are sorted into wrong depths, holes and extra ones") {
    //                             equal  nearly  wrong  hole  extra  empty
    const std::vector<float> reference{10, 100, 100, 5, 0, 0};
    const std::vector<float> picture{10, 100.9f, 102, 0, 7, 0};
    auto error = depthError(reference, picture);
    CHECK(error.referencePixels == 4);
    CHECK(error.picturePixels == 4);
    CHECK(error.wrong == 1);
    CHECK(error.holes == 1);
    CHECK(error.extra == 1);
    CHECK(error.wrongShare == Approx(1.0 / 3));
    CHECK(error.holeShare == Approx(1.0 / 4));
    CHECK(error.extraShare == Approx(1.0 / 2));
    CHECK(depthError(reference, picture, 0.001).wrong == 2);
}

TEST_CASE(
    "a nearer surface is as wrong as a farther one, and pictures without points have no share of anything") {
    const std::vector<float> surface{100, 100}, nearer{98, 102};
    CHECK(depthError(surface, nearer).wrong == 2);
    const std::vector<float> empty{0, 0};
    auto nothing = depthError(empty, empty);
    CHECK(nothing.wrongShare == 0);
    CHECK(nothing.holeShare == 0);
    CHECK(nothing.extraShare == 0);
    CHECK(depthError(surface, empty).holeShare == 1);
    CHECK(depthError(empty, surface).extraShare == 1);
}
