#include "converter/build/convert.hpp"
#include "converter/synth/synthesize.hpp"
#include "shared/base/text.hpp"
#include "shared/las/las_writer.hpp"
#include "tests/golden/scene.hpp"

#include <cmath>
#include <filesystem>
#include <functional>
#include <set>

namespace stipple::golden {
namespace {

struct Waves {
    std::uint64_t points = 40000;
    double side = 80; // world units
    Vec3d origin{637000, 4849000, 130};
    double scale = 0.01;
};

// A wave of period 1 between -1 and 1, of two parabolas.
double wave(double t) {
    double f = t - std::floor(t);
    return f < 0.5 ? 16 * f * (0.5 - f) : -16 * (f - 0.5) * (1 - f);
}

// Height over the unit square: two crossing waves; on a line across it, pillars.
double heightAt(double u, double v) {
    double ground = 0.05 * wave(1.5 * u + 0.2) + 0.03 * wave(2.5 * v);
    bool pillar = std::abs(v - 0.5) < 0.02 && u * 10 - std::floor(u * 10) < 0.4;
    return pillar ? 0.18 : ground;
}

Status writeWaves(const Waves& waves, const std::string& path) {
    las::WriterOptions options;
    options.grid = {{waves.scale, waves.scale, waves.scale}, waves.origin};
    options.schema = las::schemaOf(2);
    options.pointFormat = 2;
    options.expectedPoints = waves.points;
    const Schema& schema = options.schema;
    STIPPLE_TRY(writer, las::Writer::create(path, options));
    PointBatch batch;
    batch.resize(schema, waves.points);
    int intensity = schema.find(attribute_names::intensity);
    int red = schema.find(attribute_names::red), green = schema.find(attribute_names::green),
        blue = schema.find(attribute_names::blue);
    for (std::size_t i = 0; i < waves.points; ++i) {
        // Two irrational steps cover the square evenly, in integers: multiples of 2^32 / φ₂ and 2^32 / φ₂²,
        // φ₂ = 1.32471795… (Roberts 2018, "R2").
        auto a = static_cast<std::uint32_t>(i * 3242174889u), b = static_cast<std::uint32_t>(i * 2447445414u);
        double u = a * 0x1p-32, v = b * 0x1p-32, h = heightAt(u, v);
        auto steps = [&](double unit) {
            return static_cast<std::int64_t>(std::floor(unit * waves.side / waves.scale));
        };
        // Pillars are drawn out from foot to top.
        double z = h > 0.1 ? h * (static_cast<double>((i * 7919) % 1000) / 1000) : h;
        batch.positions[i] = {steps(u), steps(v), steps(z + 0.1)};
        bool dark = (static_cast<int>(u * 8) + static_cast<int>(v * 8)) % 2 != 0;
        auto level = [](double value) { return static_cast<std::uint16_t>(std::floor(value * 255) * 257); };
        batch.setValue<std::uint16_t>(red, i, level(dark ? 0.35 : 0.85));
        batch.setValue<std::uint16_t>(green, i, level(u));
        batch.setValue<std::uint16_t>(blue, i, level(v));
        batch.setValue<std::uint16_t>(intensity, i,
                                      static_cast<std::uint16_t>(4000 * (0.5 + 0.5 * wave(3 * u))));
    }
    STIPPLE_CHECK(writer->write(batch));
    return writer->finish();
}

Status writeScan(const nlohmann::json& cloud, const std::string& path) {
    std::string kind = cloud.value("kind", "");
    std::uint64_t points = cloud.value("points", std::uint64_t{0});
    if (points < 1 || points > 1'000'000)
        return Error{ErrorCode::invalidArgument, "points must be in 1..1000000", "cloud", ""};
    if (kind == "waves") {
        Waves waves;
        waves.points = points;
        waves.side = cloud.value("side", waves.side);
        waves.scale = cloud.value("scale", waves.scale);
        auto origin =
            cloud.value("origin", std::vector<double>{waves.origin.x, waves.origin.y, waves.origin.z});
        if (origin.size() != 3)
            return Error{ErrorCode::invalidArgument, "origin must be three numbers", "cloud", ""};
        waves.origin = {origin[0], origin[1], origin[2]};
        return writeWaves(waves, path);
    }
    if (kind == "synth" && cloud.value("scene", "") == "town") {
        synth::SynthOptions options;
        options.points = points;
        options.seed = cloud.value("seed", std::uint64_t{1});
        options.normals = cloud.value("normals", false);
        auto report = synth::synthesize(path, options, [](std::uint64_t, std::uint64_t) {});
        return report.ok() ? Status() : Status(report.error());
    }
    return Error{ErrorCode::invalidArgument, cat("there is no cloud of kind '", kind, "'"), "cloud", ""};
}

Result<ConvertOptions> optionsOf(const nlohmann::json& cloud) {
    ConvertOptions options;
    options.name = "golden";
    options.threads = 1;
    const std::string colours = cloud.value("colours", "");
    for (std::size_t i = 0; i < innerColourNames.size(); ++i)
        if (colours == innerColourNames[i])
            options.innerColour = static_cast<InnerColour>(i);
    if (!colours.empty() && !options.innerColour)
        return Error{ErrorCode::invalidArgument, "colours must be exact or mean", "cloud", ""};
    return options;
}

} // namespace

Result<std::string> makeCloud(const nlohmann::json& cloud, const std::string& workFolder) {
    static std::set<std::string> made;
    std::string text = cloud.dump();
    std::string base = cat(workFolder, "/", cloud.value("kind", ""), "-", std::hash<std::string>()(text));
    std::string output = base + ".stipple";
    if (made.count(output))
        return output;
    std::filesystem::remove(output);
    STIPPLE_TRY(options, optionsOf(cloud));
    STIPPLE_CHECK(writeScan(cloud, base + ".las"));
    auto converted = convertFiles({base + ".las"}, output, options,
                                  [](const std::string&, std::uint64_t, std::uint64_t) {});
    if (!converted.ok())
        return converted.error();
    made.insert(output);
    return output;
}

} // namespace stipple::golden
