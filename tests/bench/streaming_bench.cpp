// Time, requests and bytes until the picture is right, over simulated networks: streaming_bench CLOUD...
// For each cloud, network (Mbit/s x ms of round trip) and way of loading, sums over all cameras of all paths
// of what it took from setting the camera until the mean pixel error fell below 10, 5 and 2 %, and until
// nothing more was wanted. Prints a Markdown table.
//
// Errors are against the picture of all points in the same style (by the software renderer, which is within
// the bounds of NUMERICS.md of the reference), not against what each way ends with: ways that end with
// different points are then measured by the same thing, and what a way never shows counts against it.
#include "client/core/json.hpp"
#include "client/headless/png.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/verb.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/bench/streaming_run.hpp"
#include "tests/bench/streaming_ways.hpp"

#include <cstdio>
#include <optional>
#include <string>
#include <vector>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Options {
    std::vector<std::string> clouds;
    std::vector<std::string> networks{"5x5",    "5x50",  "5x200",  "50x5",   "50x50",
                                      "50x200", "500x5", "500x50", "500x200"};
    std::vector<std::string> paths{"fly-over", "walk", "jump"};
    std::vector<std::string> ways{"all", "plain"};
    int frames = 3, connections = 6;
    int width = 1280, height = 720;
    std::uint64_t budget = 2'000'000;
    double spacing = 1;
    bool each = false;
    std::vector<double> at; // seconds
    std::string pictures;
};

std::vector<StreamingScene> scenesOf(const std::string& path, const Options& options) {
    auto source = need(openFileSource(path));
    BoxD bounds = need(CloudReader::open(*source))->metadata().worldBounds();
    auto file = hosted(path);
    std::vector<StreamingScene> scenes;
    for (const std::string& name : options.paths) {
        StreamingScene scene;
        scene.name = name;
        scene.file = file;
        scene.width = options.width;
        scene.height = options.height;
        scene.cameras = need(bench::builtInPath(name, bounds, options.frames)).cameras;
        scene.targets = need(targetPictures(path, scene.cameras, scene.width, scene.height));
        scenes.push_back(std::move(scene));
    }
    return scenes;
}

void cell(const Milestone& milestone) {
    if (milestone.isReached)
        std::printf(" %.2f, %.0f, %.2f |", milestone.seconds, milestone.requests, milestone.bytes / 1e6);
    else
        std::printf(" - |");
}

void row(const std::string& cloud, const std::string& network, const std::string& way,
         const StreamingResult& result, double runs) {
    std::printf("| %s | %s | %s |", cloud.c_str(), network.c_str(), way.c_str());
    cell(result.firstPicture);
    for (const Milestone& milestone : result.belowError)
        cell(milestone);
    cell(result.settled);
    std::printf(" %.2f %% |\n", 100 * result.settledError / runs);
    std::fflush(stdout);
}

void measure(const std::string& path, const Options& options) {
    std::vector<StreamingScene> scenes = scenesOf(path, options);
    std::string cloud = path.substr(path.find_last_of('/') + 1);
    for (const std::string& network : options.networks)
        for (const StreamingWay& way : streamingWays(options.ways, options.budget, options.spacing)) {
            std::optional<StreamingResult> sum;
            for (const StreamingScene& scene : scenes) {
                StreamingResult result =
                    need(runStreaming(scene, way, networkOf(network, options.connections), options.at));
                for (std::size_t i = 0; i < result.pictures.size(); ++i)
                    need(headless::writePng(cat(options.pictures, "/", scene.name, " ", network, " ",
                                                way.name, " ", options.at[i], " s.png"),
                                            result.pictures[i]));
                if (options.each)
                    row(cloud + ", " + scene.name, network, way.name, result, 1);
                if (sum)
                    *sum += result;
                else
                    sum = result;
            }
            row(cloud, network, way.name, *sum, static_cast<double>(scenes.size()));
        }
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App program("Time, requests and bytes until the picture is right, over simulated networks");
    program.add_option("clouds", options.clouds, ".stipple files")->required()->check(CLI::ExistingFile);
    program.add_option("--networks", options.networks, "MBITxMS, …")->delimiter(',')->capture_default_str();
    program.add_option("--paths", options.paths, "Camera paths of `stipple bench`")
        ->delimiter(',')
        ->capture_default_str();
    program.add_option("--ways", options.ways, "Of loading")->delimiter(',')->capture_default_str();
    program.add_option("--frames", options.frames, "Cameras of a path")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    program.add_option("--width", options.width, "Of the picture, pixels")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    program.add_option("--height", options.height, "Likewise")
        ->check(CLI::Range(16, 4096))
        ->capture_default_str();
    program.add_option("--budget", options.budget, "Points")->capture_default_str();
    program.add_option("--spacing", options.spacing, "Of continuous detail, pixels")->capture_default_str();
    program.add_option("--connections", options.connections, "Of the client to the server")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    auto at =
        program
            .add_option("--at", options.at, "Seconds after which the first camera of a path is to be drawn")
            ->delimiter(',');
    at->needs(program.add_option("--pictures", options.pictures, "Folder for these pictures")
                  ->check(CLI::ExistingDirectory));
    program.add_flag("--each", options.each, "A row for each path, too");
    CLI11_PARSE(program, argc, argv);
    std::printf(
        "| cloud | Mbit/s x ms | way | first picture: s, requests, MB | below 10 %% | 5 %% | 2 %% | settled "
        "| settled error |\n|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& cloud : options.clouds)
        measure(cloud, options);
}
