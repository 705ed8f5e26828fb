// stipple bench CLOUD... -o FOLDER: time against error of every way of drawing.
#include "client/bench/bench.hpp"
#include "client/bench/report.hpp"
#include "client/core/json.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/number_check.hpp"
#include "shared/cli/verb.hpp"
#include "shared/io/output_file.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

namespace stipple {

void addBenchVerb(CLI::App& program, cli::Action& action);

namespace {

using namespace bench;

struct Words {
    std::string output, size = "1280x720", camerasFile, modesFile, cache;
    std::vector<std::string> paths, modes;
    std::vector<double> budgets{0.1, 0.2, 0.5, 1, 2, 5, 10, 20}; // millions
    double usualBudget = 2;
    bool listModes = false, noPictures = false, json = false, quiet = false;
    BenchOptions options;
};

Result<nlohmann::json> readJson(const std::string& path) {
    std::ifstream file(path);
    if (!file)
        return Error{ErrorCode::notFound, "the file can't be opened", path, ""};
    std::string text((std::istreambuf_iterator<char>(file)), {});
    return parseJson(text, path);
}

Result<std::uint64_t> pointsOf(double millions) {
    if (!(millions > 0 && millions <= 1e6))
        return Error{ErrorCode::invalidArgument, cat(millions, " is no number of million points"),
                     "--budgets", ""};
    return static_cast<std::uint64_t>(std::llround(millions * 1e6));
}

Result<std::vector<Mode>> chosenModes(const Words& words) {
    std::vector<Mode> all = builtInModes();
    if (!words.modesFile.empty()) {
        STIPPLE_TRY(json, readJson(words.modesFile));
        STIPPLE_TRY(further, modesFromJson(json));
        if (words.modes.empty())
            return std::move(further);
        all.insert(all.end(), further.begin(), further.end());
    }
    if (words.modes.empty())
        return all;
    std::vector<Mode> chosen;
    for (const std::string& name : words.modes) {
        auto found =
            std::find_if(all.begin(), all.end(), [&](const Mode& mode) { return mode.name == name; });
        if (found == all.end())
            return Error{ErrorCode::invalidArgument, cat("there is no mode '", name, "'"), "--modes",
                         "--list-modes lists them"};
        chosen.push_back(*found);
    }
    return chosen;
}

Result<BenchOptions> optionsOf(const Words& words) {
    BenchOptions options = words.options;
    int read = 0;
    if (std::sscanf(words.size.c_str(), "%5dx%5d%n", &options.width, &options.height, &read) != 2 ||
        static_cast<std::size_t>(read) != words.size.size())
        return Error{ErrorCode::invalidArgument, cat("'", words.size, "' is no picture size"), "--size",
                     "write WIDTHxHEIGHT, for example 1280x720"};
    options.pathNames = words.paths;
    if (!words.camerasFile.empty()) {
        STIPPLE_TRY(json, readJson(words.camerasFile));
        STIPPLE_TRY(paths, pathsFromJson(json));
        options.paths = std::move(paths);
    } else if (words.paths.empty()) {
        for (std::string_view name : pathNames())
            options.pathNames.emplace_back(name);
    }
    STIPPLE_TRY(modes, chosenModes(words));
    options.modes = std::move(modes);
    options.budgets.clear();
    for (double millions : words.budgets) {
        STIPPLE_TRY(points, pointsOf(millions));
        options.budgets.push_back(points);
    }
    STIPPLE_TRY(usual, pointsOf(words.usualBudget));
    options.usualBudget = usual;
    options.cacheFolder = words.cache.empty() ? words.output + "/references" : words.cache;
    options.pictures = !words.noPictures;
    return options;
}

// A line on standard error every two seconds, and whenever another thing begins.
class ProgressLines {
  public:
    void operator()(const std::string& phase, std::uint64_t done, std::uint64_t total) {
        auto now = std::chrono::steady_clock::now();
        if (phase == phase_ && now - last_ < std::chrono::seconds(2))
            return;
        phase_ = phase;
        last_ = now;
        std::fprintf(stderr, "%s: %llu of %llu\n", phase.c_str(), static_cast<unsigned long long>(done),
                     static_cast<unsigned long long>(total));
    }

  private:
    std::string phase_;
    std::chrono::steady_clock::time_point last_;
};

Status writeText(const std::string& path, const std::string& text) {
    STIPPLE_TRY(file, OutputFile::create(path));
    STIPPLE_CHECK(file->append({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
    return file->commit();
}

Status writeReports(const std::string& folder, const BenchResult& result) {
    STIPPLE_TRY(html, htmlOf(result));
    STIPPLE_CHECK(writeText(folder + "/report.json", toJson(result).dump(1) + "\n"));
    STIPPLE_CHECK(writeText(folder + "/frames.csv", csvOf(result)));
    return writeText(folder + "/report.html", html);
}

void printSummaries(const BenchResult& result) {
    std::printf("%-14s %-14s %8s %9s %9s %8s %7s %7s %7s %7s\n", "cloud", "mode", "budget", "draw ms",
                "drawn", "error %", "SSIM", "FLIP", "depth %", "holes %");
    for (const Summary& s : summarise(result.runs))
        std::printf("%-14s %-14s %6.2f M %9.2f %7.2f M %8.3f %7.4f %7.4f %7.2f %7.2f\n", s.cloud.c_str(),
                    s.mode.c_str(), double(s.budget) / 1e6, s.drawSeconds * 1e3, s.pointsDrawn / 1e6,
                    s.meanError / 2.55, s.ssim, s.flip, s.wrongDepth * 100, s.holes * 100);
}

int listModes(const Words& words) {
    auto modes = chosenModes(words);
    if (!modes.ok())
        return cli::fail("bench", modes.error());
    for (const Mode& mode : *modes)
        std::printf("%-14s %s%s\n", mode.name.c_str(), mode.about.c_str(),
                    mode.sweep ? " (every budget)" : "");
    return cli::success;
}

Status run(const Words& words) {
    if (words.output.empty() || words.options.clouds.empty())
        return Error{ErrorCode::invalidArgument, "clouds and a folder for the reports are needed", "",
                     "stipple bench CLOUD.stipple -o FOLDER"};
    STIPPLE_TRY(options, optionsOf(words));
    std::error_code failed;
    std::filesystem::create_directories(words.output, failed);
    if (failed)
        return Error{ErrorCode::writeFailed, cat("the folder can't be made: ", failed.message()),
                     words.output, ""};
    if (!words.quiet)
        options.progress = ProgressLines();
    STIPPLE_TRY(result, runBench(options));
    for (const CloudResult& cloud : result.clouds)
        for (const std::string& sentence : cloud.limitations)
            std::fprintf(stderr, "warning: %s\n", sentence.c_str());
    STIPPLE_CHECK(writeReports(words.output, result));
    if (words.json) {
        nlohmann::json answer = toJson(result);
        std::printf("%s\n", jsonText(answer["summaries"]).c_str());
    } else {
        printSummaries(result);
        std::printf("%s/report.html, report.json, frames.csv\n", words.output.c_str());
    }
    return {};
}

} // namespace

void addBenchVerb(CLI::App& program, cli::Action& action) {
    auto words = std::make_shared<Words>();
    BenchOptions& options = words->options;
    CLI::App* verb =
        program.add_subcommand("bench", "Measure time against error of every way of drawing clouds");
    verb->add_option("clouds", options.clouds, "Files (.stipple)");
    verb->add_option("-o,--output", words->output, "Folder for report.html, report.json and frames.csv");
    verb->add_option("--paths", words->paths,
                     "Camera paths: fly-over, walk, orbit, jump, dolly, map (default: all)")
        ->delimiter(',');
    verb->add_option("--cameras", words->camerasFile,
                     "Further paths: a JSON file {\"paths\": [{\"name\": \"…\", \"cameras\": [{…}]}]}; alone "
                     "without --paths");
    verb->add_option("--frames", options.frames, "Of each of the paths that are named")
        ->check(cli::wholeNumber(1, 10000))
        ->capture_default_str();
    verb->add_option("--modes", words->modes, "Ways of drawing (default: all)")->delimiter(',');
    verb->add_option("--modes-file", words->modesFile, "Further modes: a JSON list; alone without --modes");
    verb->add_flag("--list-modes", words->listModes, "List the modes and end");
    verb->add_option("--budgets", words->budgets, "Millions of points, for the modes that sweep")
        ->delimiter(',')
        ->capture_default_str();
    verb->add_option("--budget", words->usualBudget, "Millions of points, for the other modes")
        ->capture_default_str();
    verb->add_option("--size", words->size, "Width and height in pixels")->capture_default_str();
    verb->add_option("--repeats", options.repeats, "Warm passes along each path that times are medians of")
        ->check(cli::wholeNumber(0, 1000))
        ->capture_default_str();
    verb->add_option("--samples", options.samples, "Samples a pixel of the references, along each side")
        ->check(cli::wholeNumber(1, 16))
        ->capture_default_str();
    verb->add_option("--threads", options.threads, "Of decoding and drawing; 0: one per core")
        ->check(cli::wholeNumber(0, 256))
        ->capture_default_str();
    verb->add_option("--cache", words->cache,
                     "Folder that keeps reference pictures (default: references in the output)");
    verb->add_flag("--no-pictures", words->noPictures, "Leave pictures out of the report");
    verb->add_flag("--quiet", words->quiet, "No progress");
    verb->add_flag("--json", words->json, "Print the summaries as JSON");
    verb->callback([words, &action] {
        action = [words] {
            if (words->listModes)
                return listModes(*words);
            Status status = run(*words);
            return status.ok() ? static_cast<int>(cli::success) : cli::fail("bench", status.error());
        };
    });
}

} // namespace stipple
