// stipple verify FILE [--against INPUT...]
#include "converter/build/verify.hpp"
#include "converter/input/expand.hpp"
#include "converter/verbs/interrupt.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "converter/verbs/reading_options.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"

#include <fmt/format.h>
#include <memory>

namespace stipple {

namespace {
struct VerifyArguments {
    std::string file;
    std::vector<std::string> inputs;
    VerifyOptions options;
    bool json = false;
};

cli::Json comparisonJson(const VerifyReport& report) {
    if (!report.comparison)
        return nullptr;
    const Comparison& comparison = *report.comparison;
    cli::Json json = {{"filePoints", comparison.filePoints},   {"inputPoints", comparison.inputPoints},
                      {"equalPoints", comparison.equalPoints}, {"changed", comparison.changed},
                      {"missing", comparison.missing},         {"surplus", comparison.surplus}};
    json["changedPerAttribute"] = cli::Json::object();
    for (std::size_t a = 0; a < report.attributeNames.size(); ++a)
        json["changedPerAttribute"][report.attributeNames[a]] = comparison.changedPerAttribute[a];
    json["first"] = cli::Json::array();
    for (const Comparison::Difference& difference : comparison.first)
        json["first"].push_back(difference.text);
    return json;
}

cli::Json reportJson(const std::string& file, const VerifyReport& report) {
    cli::Json json = {{"file", file},
                      {"passed", report.passed()},
                      {"bytes", report.fileBytes},
                      {"nodes", report.nodes},
                      {"points", report.points},
                      {"spacedPoints", report.spacedPoints},
                      {"tooNear", report.tooNear},
                      {"faultCount", report.faultCount}};
    json["faults"] = report.faults;
    json["warnings"] = report.warnings;
    json["notes"] = report.notes;
    json["comparison"] = comparisonJson(report);
    return json;
}

void printComparison(const VerifyReport& report) {
    const Comparison& comparison = *report.comparison;
    fmt::print("against the inputs: {} points in them, {} in the file, {} equal", comparison.inputPoints,
               comparison.filePoints, comparison.equalPoints);
    if (comparison.same()) {
        fmt::print("; every point is there once, with all {} attributes\n", report.attributeNames.size());
        return;
    }
    fmt::print("; {} changed, {} missing, {} surplus\n", comparison.changed, comparison.missing,
               comparison.surplus);
    for (std::size_t a = 0; a < report.attributeNames.size(); ++a)
        if (comparison.changedPerAttribute[a] > 0)
            fmt::print("  {} differs in {} points\n", report.attributeNames[a],
                       comparison.changedPerAttribute[a]);
    for (const Comparison::Difference& difference : comparison.first)
        fmt::print("  {}\n", difference.text);
}

void printText(const std::string& file, const VerifyReport& report) {
    for (const std::string& warning : report.warnings)
        fmt::print(stderr, "warning: {}\n", warning);
    for (const std::string& note : report.notes)
        fmt::print("note: {}\n", note);
    for (const std::string& fault : report.faults)
        fmt::print("fault: {}\n", fault);
    if (report.faultCount > report.faults.size())
        fmt::print("and {} more faults\n", report.faultCount - report.faults.size());
    fmt::print("{}: {} points in {} nodes, {} bytes; of {} points in inner nodes with a minimum distance {} "
               "break it\n",
               file, report.points, report.nodes, report.fileBytes, report.spacedPoints, report.tooNear);
    if (report.comparison)
        printComparison(report);
    fmt::print("{}\n", report.passed() ? "passed" : "FAILED");
}

int runVerify(VerifyArguments& arguments) {
    auto inputs = expandInputs(arguments.inputs, arguments.file);
    if (!inputs)
        return cli::fail("verify", inputs.error());
    cli::Progress bar(arguments.json ? cli::ProgressStyle::none : cli::ProgressStyle::text);
    arguments.options.stop = cli::stopOnInterrupt();
    arguments.options.temporaryBytes = &bar.temporaryBytes;
    auto report = verifyFile(arguments.file, inputs->paths, arguments.options,
                             [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                 bar.update(phase, done, total);
                             });
    bar.finish();
    if (!report)
        return cli::fail("verify", report.error());
    report->warnings.insert(report->warnings.begin(), inputs->warnings.begin(), inputs->warnings.end());
    if (arguments.json)
        cli::printJson(reportJson(arguments.file, *report));
    else
        printText(arguments.file, *report);
    return report->passed() ? cli::success : cli::verificationFailed;
}
} // namespace

void addVerifyVerb(CLI::App& program, cli::Action& action) {
    auto arguments = std::make_shared<VerifyArguments>();
    CLI::App* verb = program.add_subcommand("verify", "Check a .stipple file, alone or against its inputs");
    verb->add_option("FILE", arguments->file, "The .stipple file")->required();
    verb->add_option("--against", arguments->inputs,
                     "Scans, folders or patterns, as given to convert: prove that the file holds exactly "
                     "their points, every attribute equal");
    cli::addReadingOptions(*verb, arguments->options.reading);
    cli::addResourceOptions(*verb, arguments->options.threads, arguments->options.memoryBytes);
    verb->add_option("--temp", arguments->options.temp,
                     "Folder for what does not fit memory (default: that of FILE)")
        ->check(CLI::ExistingDirectory);
    verb->add_flag("--json", arguments->json, "Print the report as one JSON object; no progress");
    verb->callback([arguments, &action] { action = [arguments] { return runVerify(*arguments); }; });
}

} // namespace stipple
