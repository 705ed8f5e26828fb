// Counts and errors of rendering, held against errors.json beside this file: what a change to selection,
// loading or drawing does to them shows here. Never times.
//
//   error_golden [--update] [--golden FILE] [--work FOLDER]
//
// Counts must be equal; errors may differ by 0.0005 of their unit or half a per cent (functions of the C
// library round differently on some processors). --update writes the file anew, and such a run never passes.
#include "client/bench/bench.hpp"
#include "shared/base/text.hpp"
#include "tests/golden/scene.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

using namespace stipple;
using nlohmann::json;

namespace {

constexpr double absoluteSlack = 0.0005, relativeSlack = 0.005;

struct Arguments {
    bool update = false;
    std::string golden = STIPPLE_SOURCE_DIR "/tests/bench/errors.json", work = "error_golden";
};

Arguments argumentsOf(int argc, char** argv) {
    Arguments arguments;
    for (int i = 1; i < argc; ++i) {
        std::string word = argv[i];
        if (word == "--update")
            arguments.update = true;
        else if (word == "--golden" && i + 1 < argc)
            arguments.golden = argv[++i];
        else if (word == "--work" && i + 1 < argc)
            arguments.work = argv[++i];
    }
    return arguments;
}

// Hills and a row of pillars in plain arithmetic, and a scan of a town. With exact colours: so what is drawn
// of all points differs from the reference in nothing.
const std::pair<const char*, json> clouds[] = {
    {"waves", {{"kind", "waves"}, {"points", 120000}, {"colours", "exact"}}},
    {"town", {{"kind", "synth"}, {"scene", "town"}, {"points", 150000}, {"seed", 1}, {"colours", "exact"}}},
    {"normals",
     {{"kind", "synth"},
      {"scene", "town"},
      {"points", 60000},
      {"seed", 1},
      {"colours", "exact"},
      {"normals", true}}}};

// Modes of discs are of the cloud with normals alone, and it of them.
bool concerns(const bench::Mode& mode, const json& cloud) {
    return mode.name.starts_with("discs") == cloud.value("normals", false);
}

Result<bench::BenchOptions> optionsFor(const json& made, const std::string& cloud) {
    bench::BenchOptions options;
    options.clouds = {cloud};
    for (std::string_view name : bench::pathNames())
        options.pathNames.emplace_back(name);
    for (const bench::Mode& mode : bench::builtInModes())
        if (mode.backend == headless::Backend::software && concerns(mode, made)) // drivers differ
            options.modes.push_back(mode);
    options.budgets = {10'000, 50'000, 1'000'000};
    options.usualBudget = 50'000;
    options.width = 192;
    options.height = 144;
    options.frames = 2;
    options.repeats = 0;
    options.pictures = false;
    return options;
}

double rounded(double value) {
    return std::round(value * 1e4) / 1e4;
}

json lineOf(const bench::FrameResult& f) {
    return {{"pointsConsidered", f.counters.pointsConsidered},
            {"pointsDrawn", f.counters.pointsDrawn},
            {"nodesDrawn", f.counters.nodesDrawn},
            {"nodesVisited", f.counters.nodesVisited},
            {"bytesFetched", f.bytesFetched},
            {"requests", f.requests},
            {"meanError", rounded(f.pixels.mean)},
            {"ssim", rounded(f.ssim)},
            {"flip", rounded(f.flip)},
            {"wrongDepth", rounded(f.depth.wrongShare)},
            {"holes", rounded(f.depth.holeShare)},
            {"extra", rounded(f.depth.extraShare)}};
}

// "town/orbit/default/0.05M/1" → counts and errors of that frame.
Status addFrames(const char* name, const json& cloud, const std::string& work, json& frames) {
    STIPPLE_TRY(file, golden::makeCloud(cloud, work));
    STIPPLE_TRY(options, optionsFor(cloud, file));
    STIPPLE_TRY(result, bench::runBench(options));
    for (const bench::Run& run : result.runs)
        for (std::size_t i = 0; i < run.frames.size(); ++i)
            frames[cat(name, "/", run.path, "/", run.mode, "/", double(run.budget) / 1e6, "M/", i)] =
                lineOf(run.frames[i]);
    return {};
}

bool agrees(const json& expected, const json& actual) {
    if (!expected.is_number_float() && !actual.is_number_float())
        return expected == actual;
    double a = expected.get<double>(), b = actual.get<double>();
    return std::abs(a - b) <= std::max(absoluteSlack, relativeSlack * std::abs(a)) + 1e-12;
}

int differencesOf(const json& expected, const json& actual) {
    int differences = 0;
    for (const auto& [frame, values] : expected.items())
        if (!actual.contains(frame)) {
            std::printf("FAILED %s is gone\n", frame.c_str());
            ++differences;
        }
    for (const auto& [frame, values] : actual.items()) {
        if (!expected.contains(frame)) {
            std::printf("FAILED %s is new\n", frame.c_str());
            ++differences;
            continue;
        }
        for (const auto& [name, value] : values.items()) {
            json wanted = expected[frame].value(name, json());
            if (wanted.is_number() && agrees(wanted, value))
                continue;
            std::printf("FAILED %s: %s is %s, expected %s\n", frame.c_str(), name.c_str(),
                        value.dump().c_str(), wanted.dump().c_str());
            ++differences;
        }
    }
    return differences;
}

// One frame a line.
std::string textOf(const json& frames) {
    std::string text = "{\n";
    for (const auto& [frame, values] : frames.items())
        text += cat(text.size() > 2 ? ",\n" : "", json(frame).dump(), ": ", values.dump());
    return text + "\n}\n";
}

} // namespace

int main(int argc, char** argv) {
    Arguments arguments = argumentsOf(argc, argv);
    std::filesystem::create_directories(arguments.work);
    json frames = json::object();
    for (const auto& [name, cloud] : clouds)
        if (Status added = addFrames(name, cloud, arguments.work, frames); !added.ok()) {
            std::printf("FAILED: %s\n", added.error().sentence().c_str());
            return 1;
        }
    std::ofstream(arguments.update ? arguments.golden : arguments.work + "/errors.json") << textOf(frames);
    if (arguments.update) {
        std::printf("%s is new. Look at the differences, then run again without --update.\n",
                    arguments.golden.c_str());
        return 1;
    }
    std::ifstream file(arguments.golden);
    json expected = json::parse(file, nullptr, false);
    if (!expected.is_object() || expected.empty()) {
        std::printf("FAILED: %s can't be read\n", arguments.golden.c_str());
        return 1;
    }
    int differences = differencesOf(expected, frames);
    std::printf("%zu frames, %d differences%s\n", frames.size(), differences,
                differences ? cat("; what was measured is in ", arguments.work, "/errors.json").c_str() : "");
    return differences == 0 ? 0 : 1;
}
