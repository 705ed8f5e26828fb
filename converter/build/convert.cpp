#include "converter/build/convert.hpp"

#include "converter/build/output_check.hpp"
#include "converter/build/pack.hpp"
#include "converter/build/parallel.hpp"
#include "converter/build/sample.hpp"
#include "converter/build/scan.hpp"
#include "converter/build/spacing.hpp"
#include "converter/build/tile.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <new>
#include <tuple>

namespace stipple {

namespace fs = std::filesystem;

namespace {
constexpr std::string_view cloudMagic = "\x89STPL";
constexpr std::string_view outputExtension = ".stipple";

// Seconds since it was last asked.
class Stopwatch {
  public:
    double lap() {
        auto now = std::chrono::steady_clock::now();
        double seconds = std::chrono::duration<double>(now - start_).count();
        start_ = now;
        return seconds;
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

PictureColour pictureColour(const ColourExtremes& colour, const Schema& schema) {
    auto is16Bit = [&](std::string_view name) {
        int a = schema.find(name);
        return a >= 0 && schema.attributes[static_cast<std::size_t>(a)].type == AttributeType::u16 &&
               schema.attributes[static_cast<std::size_t>(a)].components == 1;
    };
    using namespace attribute_names;
    bool allZero = std::all_of(colour.rgbMax.begin(), colour.rgbMax.end(), [](auto max) { return max == 0; });
    if (is16Bit(red) && is16Bit(green) && is16Bit(blue) && !allZero)
        return PictureColour::rgb;
    if (is16Bit(intensity) && colour.intensityMin < colour.intensityMax)
        return PictureColour::intensity;
    return PictureColour::none;
}

std::string optionsText(const ConvertOptions& options, const Spacing& spacing) {
    std::string text =
        cat("sampling=poisson spacing=side/2^(", spacing.density, "/2) leaf-capacity=", leafCapacity);
    return options.crs.empty() ? text : cat(text, " crs=", options.crs);
}

// A cloud that is added to is no source itself: the files it was made of are.
void appendSources(std::vector<SourceFile>& sources, const InputDescription& input) {
    if (input.madeOf.empty())
        sources.push_back(input.source);
    else
        sources.insert(sources.end(), input.madeOf.begin(), input.madeOf.end());
}

CloudMetadata describe(const Scan& scan, const Tiles& tiles, const Sampled& sampled, const Spacing& spacing,
                       const std::string& output, const ConvertOptions& options) {
    CloudMetadata metadata;
    metadata.name = options.name.empty() ? fs::path(output).stem().string() : options.name;
    metadata.crs = scan.crs;
    metadata.grid = scan.grid;
    metadata.rootCube = tiles.rootCube;
    metadata.spacing = sampled.rootSpacing;
    metadata.bounds = tiles.points.bounds;
    metadata.pointCount = scan.pointCount;
    metadata.schema = scan.schema;
    metadata.pictureColour = pictureColour(tiles.points.colour, scan.schema);
    auto fits8Bit = [](std::uint16_t max) { return max <= 255; };
    metadata.colourIs8Bit =
        metadata.pictureColour == PictureColour::rgb &&
        std::all_of(tiles.points.colour.rgbMax.begin(), tiles.points.colour.rgbMax.end(), fits8Bit);
    metadata.pointHash = tiles.points.hash.hex();
    for (const ScannedInput& input : scan.inputs)
        appendSources(metadata.sources, input.description());
    std::sort(metadata.sources.begin(), metadata.sources.end(), [](const SourceFile& a, const SourceFile& b) {
        return std::tie(a.name, a.format, a.pointCount, a.sizeBytes) <
               std::tie(b.name, b.format, b.pointCount, b.sizeBytes);
    });
    metadata.tool = "stipple " STIPPLE_VERSION;
    metadata.options = optionsText(options, spacing);
    return metadata;
}

Result<ConvertResult> runPhases(const std::vector<std::string>& inputs, const std::string& output,
                                const ConvertOptions& options, const ConvertProgress& progress) {
    int threads = threadCount(options.threads);
    ConvertResult result;
    result.output = output;
    Stopwatch watch;

    STIPPLE_TRY(scan, scanInputs(inputs, ScanOptions{options.crs, {}}));
    result.warnings = scan.warnings;
    result.seconds.scan = watch.lap();

    STIPPLE_TRY(points, readPoints(scan, threads, options.stop, progress));
    result.warnings.insert(result.warnings.end(), points.warnings.begin(), points.warnings.end());
    STIPPLE_TRY(tiles, tile(std::move(points), leafCapacity, threads, options.stop));
    result.seconds.tile = watch.lap();

    STIPPLE_TRY(spacing, chooseSpacing(tiles, distanceMetric(scan.grid, scan.crs), threads, options.stop));
    STIPPLE_TRY(sampled, sample(tiles, spacing, threads, options.stop, progress));
    result.seconds.sample = watch.lap();

    result.metadata = describe(scan, tiles, sampled, spacing, output, options);
    STIPPLE_TRY(written, pack(tiles, sampled, result.metadata, output, threads, options.stop, progress));
    result.written = written;
    result.seconds.pack = watch.lap();
    return result;
}
} // namespace

Result<ConvertResult> convertFiles(const std::vector<std::string>& inputs, const std::string& output,
                                   const ConvertOptions& options, const ConvertProgress& progress) {
    STIPPLE_CHECK(checkOutput(inputs, output, options.force, cloudMagic));
    try {
        return runPhases(inputs, output, options, progress);
    } catch (const std::bad_alloc&) {
        return Error{ErrorCode::limitExceeded, "there is not enough memory", "",
                     "convert fewer inputs at once, or on a machine with more memory"};
    }
}

std::string defaultOutput(const std::vector<std::string>& inputs) {
    std::string stem = inputs.empty() ? "cloud" : fs::path(inputs[0]).stem().string();
    return stem + std::string(outputExtension);
}

} // namespace stipple
