#include "client/core/gradients.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace stipple {
namespace {

constexpr int gradientCount = 6;
constexpr std::array<const char*, gradientCount> names{"viridis",  "turbo", "inferno",
                                                       "spectral", "grey",  "terrain"};

// Evenly spaced stops, 0xRRGGBB.
// Viridis and inferno: Smith and van der Walt 2015, every tenth of the published (CC0) maps.
constexpr std::array<std::uint32_t, 11> viridisStops{0x440154, 0x482475, 0x414487, 0x355F8D,
                                                     0x2A788E, 0x21918C, 0x22A884, 0x44BF70,
                                                     0x7AD151, 0xBDDF26, 0xFDE725};
constexpr std::array<std::uint32_t, 11> infernoStops{0x000004, 0x160B39, 0x420A68, 0x6A176E,
                                                     0x932667, 0xBC3754, 0xDD513A, 0xF37819,
                                                     0xFCA50A, 0xF6D746, 0xFCFFA4};
// Brewer's diverging "Spectral" with eleven classes, from blue to red.
constexpr std::array<std::uint32_t, 11> spectralStops{0x5E4FA2, 0x3288BD, 0x66C2A5, 0xABDDA4,
                                                      0xE6F598, 0xFFFFBF, 0xFEE08B, 0xFDAE61,
                                                      0xF46D43, 0xD53E4F, 0x9E0142};
constexpr std::array<std::uint32_t, 2> greyStops{0x000000, 0xFFFFFF};
// Water's edge, meadow, dry grass, bare earth, rock, snow.
constexpr std::array<std::uint32_t, 6> terrainStops{0x2F6F7E, 0x4E9A4B, 0xC9C268,
                                                    0x9C7247, 0x8C8680, 0xFBFBFB};

struct Rgb {
    double r, g, b;
};

std::uint32_t wordOf(Rgb colour) {
    auto level = [](double value) {
        return static_cast<std::uint32_t>(std::clamp(std::floor(value + 0.5), 0.0, 255.0));
    };
    return level(colour.r) | level(colour.g) << 8 | level(colour.b) << 16 | 0xFF000000u;
}

Rgb rgbOf(std::uint32_t hex) {
    return {static_cast<double>(hex >> 16 & 255), static_cast<double>(hex >> 8 & 255),
            static_cast<double>(hex & 255)};
}

Rgb between(std::span<const std::uint32_t> stops, double t) {
    double place = t * static_cast<double>(stops.size() - 1);
    auto i = std::min(static_cast<std::size_t>(place), stops.size() - 2);
    double f = place - static_cast<double>(i);
    Rgb a = rgbOf(stops[i]), b = rgbOf(stops[i + 1]);
    return {a.r + (b.r - a.r) * f, a.g + (b.g - a.g) * f, a.b + (b.b - a.b) * f};
}

// Mikhailov 2019, "Turbo, an improved rainbow colormap": a polynomial of degree five a channel.
Rgb turbo(double t) {
    return {34.61 + t * (1172.33 - t * (10793.56 - t * (33300.12 - t * (38394.49 - t * 14825.05)))),
            23.31 + t * (557.33 + t * (1225.33 - t * (3574.96 - t * (1073.77 + t * 707.56)))),
            27.2 + t * (3211.1 - t * (15327.97 - t * (27814.0 - t * (22569.18 - t * 6838.66))))};
}

Rgb colourAt(GradientName name, double t) {
    switch (name) {
    case GradientName::viridis:
        return between(viridisStops, t);
    case GradientName::turbo:
        return turbo(t);
    case GradientName::inferno:
        return between(infernoStops, t);
    case GradientName::spectral:
        return between(spectralStops, t);
    case GradientName::grey:
        return between(greyStops, t);
    case GradientName::terrain:
        return between(terrainStops, t);
    }
    return between(greyStops, t);
}

std::array<GradientTable, gradientCount> makeTables() {
    std::array<GradientTable, gradientCount> tables;
    for (std::size_t g = 0; g < tables.size(); ++g)
        for (std::size_t i = 0; i < gradientEntries; ++i)
            tables[g][i] = wordOf(
                colourAt(static_cast<GradientName>(g), static_cast<double>(i) / (gradientEntries - 1)));
    return tables;
}

} // namespace

const GradientTable& gradientTable(GradientName name) {
    static const auto tables = makeTables();
    return tables[static_cast<std::size_t>(name)];
}

bool isColourBlindSafe(GradientName name) {
    return name == GradientName::viridis || name == GradientName::inferno || name == GradientName::grey;
}

const char* gradientNameText(GradientName name) {
    return names[static_cast<std::size_t>(name)];
}

std::optional<GradientName> gradientFromText(std::string_view text) {
    for (std::size_t i = 0; i < names.size(); ++i)
        if (text == names[i])
            return static_cast<GradientName>(i);
    return std::nullopt;
}

} // namespace stipple
