// `stipple bench` from end to end on a small cloud.
#include "client/bench/bench.hpp"
#include "client/bench/report.hpp"
#include "shared/cli/verb.hpp"
#include "tests/golden/scene.hpp"
#include "tests/support/temporary_folder.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace stipple {
void addBenchVerb(CLI::App& program, cli::Action& action);
}

using namespace stipple;
using namespace stipple::bench;
namespace fs = std::filesystem;

namespace {

const std::string& cloudFile() {
    static test::TemporaryFolder folder;
    static std::string path = [] {
        auto made = golden::makeCloud({{"kind", "waves"}, {"points", 60000}}, folder.path());
        REQUIRE(made.ok());
        return *made;
    }();
    return path;
}

std::vector<Mode> modesCalled(std::vector<std::string> names) {
    std::vector<Mode> modes;
    for (const Mode& mode : builtInModes())
        if (std::find(names.begin(), names.end(), mode.name) != names.end())
            modes.push_back(mode);
    REQUIRE(modes.size() == names.size());
    return modes;
}

BenchOptions smallBench() {
    BenchOptions options;
    options.clouds = {cloudFile()};
    options.pathNames = {"orbit", "map"};
    options.modes = modesCalled({"default", "pixels", "elevation"});
    options.budgets = {5000, 100000};
    options.usualBudget = 20000;
    options.width = 96;
    options.height = 72;
    options.frames = 2;
    options.repeats = 1;
    return options;
}

BenchResult run(const BenchOptions& options) {
    auto result = runBench(options);
    if (!result.ok())
        FAIL(result.error().sentence());
    return std::move(*result);
}

int verb(std::vector<std::string> words) {
    CLI::App program;
    cli::Action action;
    addBenchVerb(program, action);
    words.insert(words.begin(), "bench");
    std::reverse(words.begin(), words.end()); // CLI11 takes them from the back
    try {
        program.parse(words);
    } catch (const CLI::ParseError&) {
        return cli::usageError;
    }
    return action();
}

} // namespace

TEST_CASE("every cloud, path, mode and budget is run and judged", "[bench]") {
    BenchResult result = run(smallBench());
    REQUIRE(result.runs.size() == 2 * (2 + 2 + 1));
    for (const Run& r : result.runs) {
        INFO(r.path << " " << r.mode << " " << r.budget);
        REQUIRE(r.frames.size() == 2);
        for (const FrameResult& f : r.frames) {
            CHECK(f.counters.complete);
            CHECK(f.counters.pointsDrawn <= r.budget);
            CHECK(f.counters.pointsDrawn > 0);
            CHECK(f.counters.pointsConsidered >= f.counters.pointsSelected);
            CHECK(f.draw.median > 0);
            CHECK(f.draw.least <= f.draw.median);
            CHECK(f.select.median > 0);
            CHECK(f.bytesReloaded == 0);
            CHECK(f.depth.referencePixels > 500);
            CHECK(f.ssim <= 1);
        }
        CHECK(r.frames[0].bytesFetched > 0);
        CHECK_FALSE(r.frames[0].change);
        CHECK(r.frames[1].change);
    }
    CHECK(result.pictures.size() == 5); // one path each
}

// What is left when nothing is left out: the edges of circles, whose points are snapped to 1/128 pixel (those
// of squares and pixels are on the grid they snap to, and exact); single levels of lighting; the 1024 steps
// of gradients.
TEST_CASE("with every point the renderers give the reference but for roundings", "[bench]") {
    struct Bound {
        const char* mode;
        double mean, flip; // levels, FLIP
    };
    const Bound bounds[] = {{"pixels", 0.001, 0.0001}, {"squares-3", 0.003, 0.0005},
                            {"circles", 0.15, 0.008},  {"world", 0.05, 0.002},
                            {"default", 0.3, 0.008},   {"all-nodes", 0.3, 0.008},
                            {"edl-4", 0.3, 0.008},     {"intensity", 0.3, 0.012},
                            {"elevation", 0.3, 0.012}, {"continuous", 0.3, 0.008}};
    BenchOptions options = smallBench();
    options.modes.clear();
    for (const Bound& bound : bounds)
        options.modes.push_back(modesCalled({bound.mode})[0]);
    for (Mode& mode : options.modes) {
        mode.limits.minNodePixels = 0;
        mode.style.detail.spacingPixels = 0.01; // continuous detail: all of them, fully grown
    }
    options.pathNames = {"fly-over", "walk", "orbit", "jump", "dolly", "map"};
    options.budgets = {1'000'000};
    options.usualBudget = 1'000'000;
    options.repeats = 0;
    BenchResult result = run(options);
    REQUIRE(result.runs.size() == std::size(bounds) * 6);
    for (std::size_t i = 0; i < result.runs.size(); ++i)
        for (const FrameResult& f : result.runs[i].frames) {
            const Bound& bound = bounds[i / 6];
            INFO(result.runs[i].path << " " << bound.mode << ": mean " << f.pixels.mean << ", flip "
                                     << f.flip);
            CHECK(f.counters.pointsDrawn == f.counters.pointsConsidered);
            CHECK(f.pixels.mean < bound.mean);
            CHECK(f.flip < bound.flip);
            CHECK(f.ssim > 0.99);
            CHECK(f.depth.wrongShare < 0.01);
            CHECK(f.depth.holeShare < 0.003);
            CHECK(f.depth.extraShare < 0.003);
        }
}

TEST_CASE(
    "discs are nearer to the reference's discs than circles are, and a cloud without normals is told of",
    "[bench]") {
    test::TemporaryFolder folder;
    auto made = golden::makeCloud(
        {{"kind", "synth"}, {"scene", "town"}, {"points", 40000}, {"normals", true}}, folder.path());
    REQUIRE(made.ok());
    BenchOptions options = smallBench();
    options.clouds = {*made, cloudFile()};
    options.modes = modesCalled({"discs"});
    options.usualBudget = 1'000'000;
    BenchResult discs = run(options);
    CHECK(discs.clouds[0].limitations.empty());
    REQUIRE(discs.clouds[1].limitations.size() == 1);
    CHECK(discs.clouds[1].limitations[0].find("discs: ") == 0);
    CHECK(discs.clouds[1].limitations[0].find("has no normals") != std::string::npos);
    CHECK(toJson(discs)["clouds"][1]["limitations"].size() == 1);
    for (const Run& one : discs.runs)
        for (const FrameResult& frame : one.frames) {
            CHECK(frame.pixels.mean < 1); // exact but for places that are snapped, at edges of discs
            CHECK(frame.depth.wrongShare < 0.01);
        }
}

TEST_CASE("more points are nearer to the reference", "[bench]") {
    BenchOptions options = smallBench();
    options.modes = modesCalled({"all-nodes"});
    options.pathNames = {"orbit"};
    options.budgets = {2000, 10000, 60000};
    auto summaries = summarise(run(options).runs);
    REQUIRE(summaries.size() == 3);
    for (std::size_t i = 1; i < 3; ++i) {
        CHECK(summaries[i].meanError < summaries[i - 1].meanError);
        CHECK(summaries[i].flip < summaries[i - 1].flip);
        CHECK(summaries[i].ssim > summaries[i - 1].ssim);
        CHECK(summaries[i].holes <= summaries[i - 1].holes);
    }
}

TEST_CASE("references that are kept are not drawn again, and change nothing", "[bench]") {
    test::TemporaryFolder folder;
    BenchOptions options = smallBench();
    options.repeats = 0;
    options.cacheFolder = folder.file("references");
    int drawn = 0;
    options.progress = [&](const std::string& phase, std::uint64_t, std::uint64_t) {
        drawn += phase.find("reference") != std::string::npos;
    };
    BenchResult first = run(options);
    CHECK(drawn > 0);
    drawn = 0;
    BenchResult second = run(options);
    CHECK(drawn == 0);
    options.cacheFolder.clear();
    BenchResult third = run(options);
    REQUIRE(first.runs.size() == second.runs.size());
    for (std::size_t i = 0; i < first.runs.size(); ++i)
        for (std::size_t k = 0; k < first.runs[i].frames.size(); ++k) {
            CHECK(first.runs[i].frames[k].flip == second.runs[i].frames[k].flip);
            CHECK(first.runs[i].frames[k].pixels.mean == third.runs[i].frames[k].pixels.mean);
        }
}

TEST_CASE("the verb writes its three reports", "[bench]") {
    test::TemporaryFolder folder;
    std::string output = folder.file("out");
    std::ofstream(folder.file("modes.json")) << R"([{"name": "mine", "style": {"sizePixels": 5}}])";
    std::ofstream(folder.file("cameras.json")) << R"({"paths": [{"name": "here", "cameras": [
        {"position": [637040, 4848960, 150], "target": [637040, 4849040, 130]}]}]})";
    REQUIRE(verb({cloudFile(), "-o", output, "--cameras", folder.file("cameras.json"), "--modes-file",
                  folder.file("modes.json"), "--size", "64x48", "--repeats", "1", "--quiet"}) ==
            cli::success);
    for (const char* name : {"report.html", "report.json", "frames.csv"})
        CHECK(fs::file_size(output + "/" + name) > 100);
    std::ifstream file(output + "/frames.csv");
    std::string text((std::istreambuf_iterator<char>(file)), {});
    CHECK(std::count(text.begin(), text.end(), '\n') == 2);
    CHECK(text.find(",here,mine,2000000,software,0,") != std::string::npos);
    CHECK(verb({"--list-modes"}) == cli::success);
}

TEST_CASE("wrong options are refused before anything is read", "[bench]") {
    test::TemporaryFolder folder;
    std::string output = folder.file("out");
    for (std::vector<std::string> words : std::vector<std::vector<std::string>>{{"--modes", "cubism"},
                                                                                {"--paths", "swim"},
                                                                                {"--size", "9x9"},
                                                                                {"--size", "100"},
                                                                                {"--budgets", "0"},
                                                                                {"--frames", "0"},
                                                                                {"--samples", "0"}}) {
        INFO(words[0] << " " << words[1]);
        words.insert(words.end(), {"missing.stipple", "-o", output, "--quiet"});
        CHECK(verb(words) == cli::usageError);
    }
    CHECK(verb({cloudFile()}) == cli::usageError);
    CHECK(verb({"-o", output}) == cli::usageError);
    CHECK(verb({"missing.stipple", "-o", output, "--quiet"}) == cli::inputError);
    CHECK(verb({cloudFile(), "-o", output, "--cameras", folder.file("none.json"), "--quiet"}) ==
          cli::inputError);
}
