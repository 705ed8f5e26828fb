// stipple convert INPUT... [-o OUT.stipple]
#include "converter/build/convert.hpp"
#include "converter/input/expand.hpp"
#include "converter/verbs/interrupt.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace stipple {

namespace {
struct ConvertArguments {
    std::vector<std::string> inputs;
    std::string output;
    ConvertOptions options;
    bool json = false;
};

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
    fmt::print("scan {:.2f} s, tile {:.2f} s, sample {:.2f} s, pack {:.2f} s: {:.2f} s, {:.2f} M points/s\n",
               seconds.scan, seconds.tile, seconds.sample, seconds.pack, seconds.total(),
               seconds.total() > 0 ? static_cast<double>(points) / seconds.total() / 1e6 : 0.0);
}

// A cloud of a folder is named after the folder, of other inputs after the first file.
std::string chosenOutput(const ConvertArguments& arguments, const std::vector<std::string>& files) {
    if (!arguments.output.empty())
        return arguments.output;
    std::error_code error;
    std::filesystem::path first = std::filesystem::canonical(arguments.inputs[0], error);
    return !error && std::filesystem::is_directory(first, error) ? defaultOutput({first.string()})
                                                                 : defaultOutput(files);
}

int runConvert(ConvertArguments& arguments) {
    auto inputs = expandInputs(arguments.inputs, arguments.output);
    if (!inputs)
        return cli::fail("convert", inputs.error());
    cli::Progress bar(arguments.json);
    arguments.options.stop = cli::stopOnInterrupt();
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
    CLI::App* verb = program.add_subcommand("convert", "Convert LAS scans to one .stipple file");
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
    verb->add_option("--threads", arguments->options.threads, "Threads to use (default: one for each core)")
        ->check(CLI::Range(1, 1024));
    verb->add_flag("--force", arguments->options.force,
                   "Replace an existing output even if it is no Stipple file (never an input)");
    verb->add_flag("--json", arguments->json, "Print the result as one JSON object; no progress");
    verb->callback([arguments, &action] { action = [arguments] { return runConvert(*arguments); }; });
}

} // namespace stipple
