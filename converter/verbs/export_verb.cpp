// stipple export FILE -o OUT.las
#include "converter/build/export_las.hpp"
#include "converter/verbs/interrupt.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"

#include <fmt/format.h>
#include <memory>

namespace stipple {

namespace {
struct ExportArguments {
    std::string input, output;
    bool force = false, json = false;
};

int runExport(const ExportArguments& arguments) {
    cli::Progress bar(arguments.json);
    auto result = exportLas(arguments.input, arguments.output, arguments.force, cli::stopOnInterrupt(),
                            [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                bar.update(phase, done, total);
                            });
    bar.finish();
    if (!result)
        return cli::fail("export", result.error());
    const las::Header& header = result->header;
    std::string format = fmt::format("LAS {}.{}, point format {}", header.versionMajor, header.versionMinor,
                                     header.pointFormat);
    if (arguments.json) {
        cli::Json json = {{"output", result->output}, {"points", result->points}, {"format", format}};
        json["grid"] = cli::gridJson(header.grid);
        json["bounds"] = cli::boxJson(header.bounds);
        json["warnings"] = result->warnings;
        cli::printJson(json);
        return cli::success;
    }
    for (const std::string& warning : result->warnings)
        fmt::print(stderr, "warning: {}\n", warning);
    fmt::print("{}: {} points, {}\n", result->output, result->points, format);
    return cli::success;
}
} // namespace

void addExportVerb(CLI::App& program, cli::Action& action) {
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* verb = program.add_subcommand("export", "Write the points of a .stipple file to a LAS file");
    verb->add_option("FILE", arguments->input, "The .stipple file")->required();
    verb->add_option("-o,--output", arguments->output, "The LAS file to write")->required();
    verb->add_flag("--force", arguments->force, "Replace an existing output even if it is no LAS file");
    verb->add_flag("--json", arguments->json, "Print the result as one JSON object; no progress");
    verb->callback([arguments, &action] { action = [arguments] { return runExport(*arguments); }; });
}

} // namespace stipple
