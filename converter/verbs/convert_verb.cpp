// stipple convert INPUT... [-o OUT.stipple]
#include "converter/build/convert.hpp"
#include "converter/input/expand.hpp"
#include "converter/verbs/interrupt.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "converter/verbs/reading_options.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>
#include <malloc.h>
#include <memory>
#include <sys/resource.h>

namespace stipple {

namespace {
struct ConvertArguments {
    std::vector<std::string> inputs;
    std::string output;
    ConvertOptions options;
    bool json = false;
    std::string progress = "text";
};

struct ProcessCost {
    double cpuSeconds = 0;
    std::uint64_t peakMemoryBytes = 0;
};

// Of this process so far.
ProcessCost processCost() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    auto seconds = [](const timeval& time) {
        return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
    };
    return {seconds(usage.ru_utime) + seconds(usage.ru_stime),
            static_cast<std::uint64_t>(usage.ru_maxrss) * 1024};
}

double bytesPerPoint(const ConvertResult& result) {
    std::uint64_t points = result.metadata.pointCount;
    return points == 0 ? 0 : static_cast<double>(result.written.fileBytes) / static_cast<double>(points);
}

cli::Json resultJson(const ConvertResult& result) {
    const WrittenCloud& written = result.written;
    const PhaseSeconds& seconds = result.seconds;
    cli::Json json = {{"output", result.output},
                      {"points", result.metadata.pointCount},
                      {"nodes", written.nodes},
                      {"chunks", written.chunks},
                      {"bytes", written.fileBytes},
                      {"bytesPerPoint", bytesPerPoint(result)},
                      {"pictureBytes", written.pictureBytes},
                      {"attributeBytes", written.attributeBytes},
                      {"hierarchyBytes", written.hierarchyBytes},
                      {"metadataBytes", written.metadataBytes},
                      {"pointHash", result.metadata.pointHash}};
    json["seconds"] = {{"scan", seconds.scan},
                       {"tile", seconds.tile},
                       {"sample", seconds.sample},
                       {"pack", seconds.pack},
                       {"total", seconds.total()}};
    const ReadReport& dropped = result.dropped;
    json["dropped"] = {{"notFinite", dropped.notFinite},
                       {"outOfRange", dropped.outOfRange},
                       {"invalid", dropped.invalid},
                       {"untransformable", dropped.untransformable}};
    json["largestRounding"] = result.largestRounding;
    ProcessCost cost = processCost();
    json["cpuSeconds"] = cost.cpuSeconds;
    json["peakMemoryBytes"] = cost.peakMemoryBytes;
    json["temporaryBytes"] = result.temporaryBytes;
    json["resumed"] = result.resumed;
    json["warnings"] = result.warnings;
    return json;
}

void printText(const ConvertResult& result) {
    const PhaseSeconds& seconds = result.seconds;
    std::uint64_t points = result.metadata.pointCount;
    for (const std::string& warning : result.warnings)
        fmt::print(stderr, "warning: {}\n", warning);
    fmt::print("{}: {} points in {} nodes, {} bytes ({:.2f} a point)\n", result.output, points,
               result.written.nodes, result.written.fileBytes, bytesPerPoint(result));
    fmt::print("CRS: {}\n", cli::crsText(result.metadata.crs));
    ProcessCost cost = processCost();
    fmt::print("{:.1f} CPU seconds, {:.0f} MB memory at most, {:.0f} MB temporary on disk\n", cost.cpuSeconds,
               static_cast<double>(cost.peakMemoryBytes) / 1e6,
               static_cast<double>(result.temporaryBytes) / 1e6);
    fmt::print("scan {:.2f} s, tile {:.2f} s, sample {:.2f} s, pack {:.2f} s: {:.2f} s, {:.2f} M points/s\n",
               seconds.scan, seconds.tile, seconds.sample, seconds.pack, seconds.total(),
               seconds.total() > 0 ? static_cast<double>(points) / seconds.total() / 1e6 : 0.0);
}

// A cloud of a folder is named after the folder, of other inputs after the first file.
std::string chosenOutput(const ConvertArguments& arguments, const std::vector<std::string>& files) {
    if (!arguments.output.empty())
        return arguments.output;
    if (!arguments.options.append.empty())
        return arguments.options.append;
    std::error_code error;
    std::filesystem::path first = std::filesystem::canonical(arguments.inputs[0], error);
    return !error && std::filesystem::is_directory(first, error) ? defaultOutput({first.string()})
                                                                 : defaultOutput(files);
}

cli::ProgressStyle progressStyle(const ConvertArguments& arguments) {
    if (arguments.progress == "json")
        return cli::ProgressStyle::json;
    return arguments.progress == "none" || arguments.json ? cli::ProgressStyle::none
                                                          : cli::ProgressStyle::text;
}

// What is freed and asked for again a thousand times a second stays with the process: giving pages back to
// the system and getting them anew costs some 5 % of a conversion.
void keepFreedMemory() {
#ifdef __GLIBC__
    constexpr int keptBytes = 1 << 28, mappedFromBytes = 1 << 25;
    ::mallopt(M_TRIM_THRESHOLD, keptBytes);
    ::mallopt(M_MMAP_THRESHOLD, mappedFromBytes);
#endif
}

int runConvert(ConvertArguments& arguments) {
    keepFreedMemory();
    auto inputs = expandInputs(arguments.inputs, arguments.output);
    if (!inputs)
        return cli::fail("convert", inputs.error());
    cli::Progress bar(progressStyle(arguments));
    arguments.options.stop = cli::stopOnInterrupt();
    arguments.options.temporaryBytes = &bar.temporaryBytes;
    std::string output = chosenOutput(arguments, inputs->paths);
    auto result = convertFiles(inputs->paths, output, arguments.options,
                               [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                   bar.update(phase, done, total);
                               });
    bar.finish();
    if (!result)
        return cli::fail("convert", result.error());
    result->warnings.insert(result->warnings.begin(), inputs->warnings.begin(), inputs->warnings.end());
    if (arguments.json)
        cli::printJson(resultJson(*result));
    else
        printText(*result);
    return cli::success;
}
} // namespace

void addConvertVerb(CLI::App& program, cli::Action& action) {
    auto arguments = std::make_shared<ConvertArguments>();
    CLI::App* verb = program.add_subcommand("convert", "Convert scans to one .stipple file");
    verb->add_option(
            "INPUT", arguments->inputs,
            "Scans, folders of them, or patterns (\"scans/**/*.las\"); together they become one cloud")
        ->required();
    verb->add_option("-o,--output", arguments->output,
                     "The file to write (default: in the current folder, named after the first input)");
    verb->add_option("--name", arguments->options.name, "Name of the cloud (default: that of the output)");
    verb->add_option(
        "--crs", arguments->options.crs,
        "Coordinate reference system of the cloud, for example EPSG:26910: inputs in another are "
        "reprojected, inputs that state none are taken to be in it");
    cli::addResourceOptions(*verb, arguments->options.threads, arguments->options.memoryBytes);
    verb->add_option("--temp", arguments->options.temp,
                     "Folder for temporary files and checkpoints (default: beside the output)");
    verb->add_option(
        "--append", arguments->options.append,
        "Add the inputs to this .stipple file (replaced when all is done, unless -o names another)");
    verb->add_flag("--allow-duplicates", arguments->options.allowDuplicates,
                   "Take in points that a cloud among the inputs, or --append, holds already");
    cli::addReadingOptions(*verb, arguments->options.input);
    const std::vector<std::string> samplings(samplingNames.begin(), samplingNames.end());
    verb->add_option_function<std::string>(
            "--sampling",
            [arguments, samplings](const std::string& name) {
                auto at = std::find(samplings.begin(), samplings.end(), name) - samplings.begin();
                arguments->options.sampling = static_cast<Sampling>(at);
            },
            "How the points of coarse nodes are chosen: poisson (with a minimum distance; default), "
            "grid (one for each cell) or random")
        ->check(CLI::IsMember(samplings));
    verb->add_option_function<std::string>(
            "--colours",
            [arguments](const std::string& name) {
                arguments->options.innerColour =
                    name == innerColourNames[0] ? InnerColour::exact : InnerColour::mean;
            },
            "What coarse nodes show of a point: the mean colour of the area that it stands for (mean; "
            "default for RGB), or its own (exact; default for intensity), which is kept in any case")
        ->check(CLI::IsMember({innerColourNames[0], innerColourNames[1]}));
    verb->add_flag(
        "--strict", arguments->options.strict,
        "Refuse inputs with points that can't be kept (no number, out of range, marked invalid) or "
        "that were cut off");
    verb->add_option("--progress", arguments->progress,
                     "text, json (one object a line, on standard error) or none")
        ->check(CLI::IsMember({"text", "json", "none"}));
    verb->add_flag("--force", arguments->options.force,
                   "Replace an existing output even if it is no Stipple file (never an input)");
    verb->add_flag("--json", arguments->json, "Print the result as one JSON object; no progress");
    verb->callback([arguments, &action] { action = [arguments] { return runConvert(*arguments); }; });
}

} // namespace stipple
