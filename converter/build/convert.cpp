#include "converter/build/convert.hpp"

#include "converter/build/build.hpp"
#include "converter/build/known_sources.hpp"
#include "converter/build/memory_share.hpp"
#include "converter/build/output_check.hpp"
#include "converter/build/scan.hpp"
#include "converter/build/tile.hpp"
#include "converter/build/work_folder.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"
#include "shared/codec/checksum.hpp"
#include "shared/io/file_source.hpp"

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
    std::string text = cat("sampling=", samplingNames[static_cast<std::size_t>(options.sampling)],
                           " spacing=side/2^(", spacing.density, "/2) leaf-capacity=", leafCapacity);
    return options.crs.empty() ? text : cat(text, " crs=", options.crs);
}

// A cloud that is added to is no source itself: the files it was made of are.
void appendSources(std::vector<SourceFile>& sources, const InputDescription& input, const PointHash& hash) {
    if (input.madeOf.empty()) {
        sources.push_back(input.source);
        sources.back().pointHash = hash.hex();
    } else {
        sources.insert(sources.end(), input.madeOf.begin(), input.madeOf.end());
    }
}

// What is known of the cloud once every point was read.
CloudMetadata describe(const Scan& scan, const Tiles& tiles, const std::string& output,
                       const ConvertOptions& options) {
    CloudMetadata metadata;
    metadata.name = options.name.empty() ? fs::path(output).stem().string() : options.name;
    metadata.crs = scan.crs;
    metadata.grid = scan.grid;
    metadata.rootCube = tiles.grid.cube;
    metadata.bounds = tiles.sums.bounds;
    metadata.pointCount = tiles.sums.points;
    metadata.schema = scan.schema;
    metadata.pictureColour = pictureColour(tiles.sums.colour, scan.schema);
    // Means of intensities bring pictures 2 to 4 % nearer to the truth, but make them larger.
    const bool isRgb = metadata.pictureColour == PictureColour::rgb;
    if (metadata.pictureColour != PictureColour::none)
        metadata.innerColour = options.innerColour.value_or(isRgb ? InnerColour::mean : InnerColour::exact);
    auto fits8Bit = [](std::uint16_t max) { return max <= 255; };
    metadata.colourIs8Bit =
        metadata.pictureColour == PictureColour::rgb &&
        std::all_of(tiles.sums.colour.rgbMax.begin(), tiles.sums.colour.rgbMax.end(), fits8Bit);
    metadata.pointHash = tiles.sums.hash.hex();
    metadata.sampling = options.sampling;
    for (std::size_t i = 0; i < scan.inputs.size(); ++i)
        appendSources(metadata.sources, scan.inputs[i].description(), tiles.sums.inputHashes[i]);
    std::sort(metadata.sources.begin(), metadata.sources.end(), [](const SourceFile& a, const SourceFile& b) {
        return std::tie(a.name, a.format, a.pointCount, a.sizeBytes, a.pointHash) <
               std::tie(b.name, b.format, b.pointCount, b.sizeBytes, b.pointHash);
    });
    metadata.tool = "stipple " STIPPLE_VERSION;
    return metadata;
}

// What decides the bytes of the output: a checkpoint goes on only if all of it is the same.
std::string identityOf(const Scan& scan, const std::string& output, const ConvertOptions& options) {
    std::string text = cat(
        "stipple " STIPPLE_VERSION "\noutput ", fs::absolute(output).string(), "\nname ", options.name,
        "\ncrs ", options.crs, "\ncolumns ", options.input.columns, "\nscale ", options.input.scale,
        "\nsampling ", static_cast<int>(options.sampling), "\ncolours ",
        options.innerColour ? innerColourNames[static_cast<std::size_t>(*options.innerColour)] : "default",
        "\n");
    std::vector<std::string> inputs;
    for (const ScannedInput& input : scan.inputs) {
        const std::string& path = input.description().path;
        std::error_code ignored;
        auto written = fs::last_write_time(path, ignored).time_since_epoch().count();
        inputs.push_back(cat("input ", fs::absolute(path).string(), " ", input.description().source.sizeBytes,
                             " ", static_cast<std::int64_t>(written), "\n"));
    }
    // Not sorted: how far a checkpoint has read is a number in the order of the inputs.
    for (const std::string& input : inputs)
        text += input;
    return text;
}

std::string workFolderPath(const std::string& output, const ConvertOptions& options) {
    constexpr const char* ending = ".work";
    if (options.temp.empty())
        return output + ending;
    std::string absolute = fs::absolute(output).string();
    char number[17];
    std::snprintf(number, sizeof number, "%016llx",
                  static_cast<unsigned long long>(xxh64(
                      ByteSpan(reinterpret_cast<const std::uint8_t*>(absolute.data()), absolute.size()))));
    return (fs::path(options.temp) / (fs::path(output).filename().string() + "." + number + ending)).string();
}

// Points go to disk if they need more than the memory for them; said, and refused, before it starts.
Status checkDisk(const Scan& scan, std::uint64_t memoryBytes, const WorkFolder& folder,
                 ConvertResult& result) {
    std::uint64_t rows = scan.pointCount * (scan.schema.bytesPerPoint() + sizeof(Vec3<std::int32_t>));
    result.temporaryBytes = rows > memoryBytes ? rows : 0;
    return folder.resumes() ? Status{} : refuseFullDisk(rows, memoryBytes, folder.path());
}

Error ofOutput(Error error, const std::string& output) {
    if (error.code == ErrorCode::ioFailed || error.code == ErrorCode::notFound)
        error.code = ErrorCode::writeFailed;
    return error.where.find(output) == std::string::npos ? error.at(output) : error;
}

// Of the cloud that is added to. Before the output is looked at, which may be the same file.
Status checkAppended(const std::string& path, const std::vector<std::string>& inputs) {
    std::error_code none;
    if (fs::is_directory(path, none))
        return Error{ErrorCode::unsupported, "this is a folder, so nothing can be added to it", path,
                     "name the .stipple file with --append"};
    STIPPLE_TRY(source, openFileSource(path));
    auto head = source->sizeBytes() > 0 ? readNow(*source, {0, cloudMagic.size()}) : Result<Bytes>(Bytes());
    if (!head)
        return head.error();
    if (std::string_view(reinterpret_cast<const char*>(head->data()), head->size()) != cloudMagic)
        return Error{ErrorCode::unsupported, "this is no Stipple file, so nothing can be added to it", path,
                     "convert it together with the others, without --append"};
    for (const std::string& input : inputs)
        if (fs::equivalent(input, path, none))
            return Error{ErrorCode::invalidArgument, "the cloud can't be added to itself", input,
                         "leave it out of the inputs"};
    return {};
}

class Conversion {
  public:
    Conversion(const std::vector<std::string>& inputs, const std::string& output,
               const ConvertOptions& options, const ConvertProgress& progress)
        : inputs_(inputs), output_(output), options_(options), progress_(progress),
          threads_(threadCount(options.threads)), memoryBytes_(memoryForPoints(options.memoryBytes)) {}

    Result<ConvertResult> run() {
        result_.output = output_;
        ScanOptions scanning;
        scanning.crs = options_.crs;
        scanning.input = options_.input;
        scanning.input.stop = options_.stop;
        scanning.input.threads = threads_;
        auto scanned = scanInputs(inputs_, scanning);
        if (!scanned)
            return scanned.error().code == ErrorCode::cancelled ? endBeforeWork() : scanned.error();
        const Scan& scan = *scanned;
        if (Status known = checkSources(scan); !known)
            return known.error().code == ErrorCode::cancelled ? endBeforeWork() : known.error();
        result_.warnings = scan.warnings;
        result_.seconds.scan = watch_.lap();
        auto folder = WorkFolder::open(workFolderPath(output_, options_), identityOf(scan, output_, options_),
                                       result_.warnings);
        if (!folder)
            return folder.error();
        result_.resumed = (*folder)->resumes();
        Status done = attempt(scan, **folder);
        if (!done) {
            keepIfUseful(done.error(), **folder);
            return describeEnd(done.error(), **folder);
        }
        return std::move(result_);
    }

  private:
    Status checkSources(const Scan& scan) const {
        if (!options_.allowDuplicates)
            STIPPLE_CHECK(refuseKnownSources(scan, {options_.append, threads_, options_.stop}));
        return refuseLosses(scan, nullptr);
    }

    // Interrupted before the folder of checkpoints was opened, which an earlier run may have left.
    Error endBeforeWork() const {
        const std::string folder = workFolderPath(output_, options_);
        std::error_code none;
        return {ErrorCode::cancelled, "interrupted", "",
                fs::exists(folder, none) ? cat("what an earlier run has done stays in ", folder,
                                               ": the same command goes on from there, or remove that folder")
                                         : "nothing is left behind"};
    }

    Status attempt(const Scan& scan, WorkFolder& folder) {
        try {
            return runIn(scan, folder);
        } catch (const std::bad_alloc&) {
            return outOfMemory();
        }
    }

    Status runIn(const Scan& scan, WorkFolder& folder) {
        // Half of the memory for points that wait, half for those at work.
        STIPPLE_CHECK(checkDisk(scan, memoryBytes_ / 2, folder, result_));
        TileOptions tiling{threads_, memoryBytes_ / 2, options_.stop, options_.temporaryBytes,
                           options_.sizes.pointsPerRound};
        STIPPLE_TRY(tiles, tile(scan, tiling, folder, progress_));
        onDisk_ = tiles.onDisk;
        result_.dropped = tiles.sums.report();
        result_.largestRounding = std::max(result_.dropped.maxRounding, tiles.sums.maxGridError);
        STIPPLE_CHECK(refuseLosses(scan, &tiles.sums));
        for (const std::string& warning : tiles.sums.warnings(scan))
            result_.warnings.push_back(warning);
        for (const std::string& warning : equalInputs(scan, tiles.sums))
            result_.warnings.push_back(warning);
        result_.seconds.tile = watch_.lap();

        STIPPLE_TRY(blocks, folder.scratch("blocks", folder.resumes()));
        STIPPLE_TRY(journal, Journal::open(folder, folder.resumes()));
        result_.metadata = describe(scan, tiles, output_, options_);
        STIPPLE_TRY(built, build(tiles, result_.metadata,
                                 {threads_, memoryBytes_ / 2, options_.stop, options_.sizes.subtreeBytes},
                                 *blocks, journal, progress_));
        // What an earlier run put there counts too.
        result_.temporaryBytes = std::max(tiles.pool->spilledBytes(),
                                          tiles.onDisk ? tiles.sums.points * tiles.layout.rowBytes() : 0);
        result_.seconds.sample = watch_.lap();
        return pack(tiles, built, *blocks);
    }

    // With --strict: points that the files count but lack (known from the start), or that had to be dropped.
    Status refuseLosses(const Scan& scan, const PointSums* sums) const {
        constexpr std::size_t mostNamed = 5;
        std::string losses;
        std::size_t files = 0;
        for (std::size_t i = 0; options_.strict && i < scan.inputs.size(); ++i) {
            const InputDescription& input = scan.inputs[i].description();
            std::vector<std::string> texts =
                sums ? droppedTexts(sums->reports[i]) : std::vector<std::string>{};
            if (!sums && input.lostPoints > 0)
                texts.push_back(cat(input.lostPoints, " of the ", input.lostPoints + input.source.pointCount,
                                    " points that it counts are not in it"));
            if (texts.empty() || ++files > mostNamed)
                continue;
            for (std::size_t t = 0; t < texts.size(); ++t)
                losses += cat(losses.empty() ? "" : "; ", t == 0 ? cat(input.path, ": ") : "", texts[t]);
        }
        if (files == 0)
            return {};
        if (files > mostNamed)
            losses += cat("; and ", files - mostNamed, " more inputs lose points");
        return Error{ErrorCode::corrupt, losses, "", "convert without --strict to leave them out"};
    }

    Status pack(const Tiles& tiles, const Built& built, const ScratchFile& blocks) {
        CloudMetadata& metadata = result_.metadata;
        if (built.hash != tiles.sums.hash || built.points != metadata.pointCount)
            return Error{ErrorCode::corrupt,
                         cat("the points packed are not the points read (", built.points, " of ",
                             metadata.pointCount, ", hash ", built.hash.hex(), ", read ",
                             tiles.sums.hash.hex(), ")"),
                         output_, "this is a fault of stipple or of the memory; nothing was written"};
        for (const PartialStatistics& attribute : built.statistics)
            metadata.statistics.push_back(attribute.finish());
        metadata.spacing = built.spacing.world(metadata.rootCube.bits);
        metadata.options = optionsText(options_, built.spacing);
        auto written = assembleCloud(output_, metadata, built.nodes, blocks, options_.stop);
        if (!written)
            return written.error().code == ErrorCode::cancelled ? written.error()
                                                                : ofOutput(written.error(), output_);
        result_.written = *written;
        result_.seconds.pack = watch_.lap();
        return {};
    }

    // What a longer run has done stays when it could go on: the disk or the memory was full, the disk failed,
    // or somebody stopped it.
    void keepIfUseful(const Error& error, WorkFolder& folder) const {
        bool mayGoOn = error.code == ErrorCode::cancelled || error.code == ErrorCode::writeFailed ||
                       error.code == ErrorCode::ioFailed || error.code == ErrorCode::outOfMemory;
        if (mayGoOn && hasCheckpoint(folder))
            folder.keep();
        else
            kept_ = false;
    }

    bool hasCheckpoint(const WorkFolder& folder) const {
        try {
            return onDisk_ || folder.load("tiles").ok();
        } catch (const std::bad_alloc&) {
            return true; // too large to look at now, so there is one
        }
    }

    Error describeEnd(Error error, const WorkFolder& folder) const {
        auto advise = [&](const std::string& advice) {
            error.advice += cat(error.advice.empty() ? "" : "; ", advice);
        };
        if (kept_)
            advise(cat("what was done so far is kept in ", folder.path(),
                       ": the same command goes on from there, or remove that folder"));
        else if (error.code == ErrorCode::cancelled)
            advise("nothing is left behind");
        return error;
    }

    const std::vector<std::string>& inputs_;
    const std::string& output_;
    const ConvertOptions& options_;
    const ConvertProgress& progress_;
    const int threads_;
    const std::uint64_t memoryBytes_;
    Stopwatch watch_;
    ConvertResult result_;
    bool onDisk_ = false;
    mutable bool kept_ = true;
};
} // namespace

Result<ConvertResult> convertFiles(const std::vector<std::string>& inputs, const std::string& output,
                                   const ConvertOptions& options, const ConvertProgress& progress) {
    if (!options.append.empty())
        STIPPLE_CHECK(checkAppended(options.append, inputs));
    STIPPLE_CHECK(checkOutput(inputs, output, options.force, cloudMagic));
    std::vector<std::string> all = inputs;
    if (!options.append.empty())
        all.push_back(options.append);
    try {
        return Conversion(all, output, options, progress).run();
    } catch (const std::bad_alloc&) {
        return outOfMemory();
    }
}

std::string defaultOutput(const std::vector<std::string>& inputs) {
    std::string stem = inputs.empty() ? "cloud" : fs::path(inputs[0]).stem().string();
    return stem + std::string(outputExtension);
}

} // namespace stipple
