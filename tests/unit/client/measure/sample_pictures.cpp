#include "tests/unit/client/measure/sample_pictures.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <fstream>

namespace stipple::test {
namespace {

constexpr int width = 96, height = 72;

int clamped(int value) {
    return std::clamp(value, 0, 255);
}

std::uint32_t hash(int x, int y, int salt) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 374761393u +
                      static_cast<std::uint32_t>(y) * 668265263u +
                      static_cast<std::uint32_t>(salt) * 2270243519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return h ^ (h >> 16);
}

Rgb basePixel(int x, int y) {
    int check = ((x >> 3) + (y >> 3)) % 2;
    bool disc = (x - 60) * (x - 60) + (y - 30) * (y - 30) < 400;
    auto noise = static_cast<int>(hash(x, y, 1) % 16);
    return {clamped((disc ? 220 : 2 * x + 30 * check) + noise),
            clamped((disc ? 90 : 3 * y + 20 * check) + noise),
            clamped((disc ? 40 + x : 200 - x - y + 10 * check) + noise)};
}

Rgb samplePixel(const std::string& name, int x, int y) {
    Rgb pixel = basePixel(name == "shift" ? x + 2 : x, y);
    if (name == "noise")
        for (int c = 0; c < 3; ++c) {
            auto& level = pixel[static_cast<std::size_t>(c)];
            level = clamped(level + static_cast<int>(hash(x, y, 2 + c) % 61) - 30);
        }
    if (name == "dots" && hash(x, y, 7) % 20 == 0)
        pixel = {24, 26, 30};
    if (name == "tint")
        pixel = {clamped(pixel[0] - 20), pixel[1], clamped(pixel[2] + 40)};
    return pixel;
}

void append(Image& image, Rgb pixel) {
    for (int level : pixel)
        image.rgba.push_back(static_cast<std::uint8_t>(level));
    image.rgba.push_back(255);
}

} // namespace

Image constantPicture(Rgb colour, int w, int h) {
    Image image{w, h, {}};
    for (int i = 0; i < w * h; ++i)
        append(image, colour);
    return image;
}

Image samplePicture(const std::string& name, bool grey) {
    Image image{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            Rgb pixel = samplePixel(name, x, y);
            int mean = (pixel[0] + pixel[1] + pixel[2]) / 3;
            append(image, grey ? Rgb{mean, mean, mean} : pixel);
        }
    return image;
}

nlohmann::json oracleMeasures() {
    std::ifstream file(STIPPLE_SOURCE_DIR "/tests/oracles/measures.json");
    REQUIRE(file);
    return nlohmann::json::parse(file);
}

} // namespace stipple::test
