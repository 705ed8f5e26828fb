// Random numbers and directions, the same on every machine.
#pragma once

#include "shared/geometry/vec3.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace stipple::test {

class RandomPlaces {
  public:
    explicit RandomPlaces(std::uint32_t seed) : engine_(seed) {}

    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_()) / 4294967296.0);
    }
    std::int64_t integer(std::int64_t low, std::int64_t high) {
        auto width = static_cast<std::uint64_t>(high - low) + 1;
        return low + static_cast<std::int64_t>(((std::uint64_t{engine_()} << 32) | engine_()) % width);
    }
    Vec3d unit() {
        double z = between(-1, 1), turn = between(0, 2 * std::numbers::pi), r = std::sqrt(1 - z * z);
        return {r * std::cos(turn), r * std::sin(turn), z};
    }

  private:
    std::mt19937 engine_;
};

} // namespace stipple::test
