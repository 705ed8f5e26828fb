// What a moving camera shows, and what it costs, over simulated networks: flight_bench CLOUD...
// For each cloud, flight (flight.hpp), network (Mbit/s x ms of round trip) and way of loading a row of a
// Markdown table.
#include "shared/base/text.hpp"
#include "shared/cli/verb.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "tests/bench/flight.hpp"
#include "tests/bench/streaming_ways.hpp"

#include <algorithm>
#include <cstdio>
#include <string>
#include <vector>

using namespace stipple;
using namespace stipple::test;

namespace {

struct Options {
    std::vector<std::string> clouds;
    std::vector<std::string> networks{"5x5",    "5x50",  "5x200",  "50x5",   "50x50",
                                      "50x200", "500x5", "500x50", "500x200"};
    std::vector<std::string> flights;
    std::vector<std::string> ways{"all"};
    double seconds = 6, rest = 2;
    int samples = 12, connections = 6;
    int width = 1280, height = 720;
    std::uint64_t budget = 2'000'000;
    double spacing = 0.5;
};

FlightScene sceneOf(const std::string& path, const std::string& flight, const Options& options) {
    auto source = need(openFileSource(path));
    BoxD bounds = need(CloudReader::open(*source))->metadata().worldBounds();
    FlightScene scene;
    scene.name = flight;
    scene.file = hosted(path);
    scene.width = options.width;
    scene.height = options.height;
    double aspect = static_cast<double>(options.width) / options.height;
    scene.cameras = need(flightCameras(flight, bounds, options.seconds, aspect));
    double interval = options.seconds * flightFramesPerSecond / options.samples;
    auto resting = static_cast<int>(options.rest * options.samples / options.seconds);
    std::vector<Camera> sampled;
    for (int i = 1; i <= options.samples + std::max(1, resting); ++i) {
        scene.samples.push_back(static_cast<std::size_t>(i * interval) - 1);
        sampled.push_back(scene.cameras[std::min(scene.samples.back(), scene.cameras.size() - 1)]);
    }
    // At rest the target stays.
    std::vector<Camera> moving(sampled.begin(), sampled.begin() + options.samples);
    scene.targets = need(targetPictures(path, moving, scene.width, scene.height));
    while (scene.targets.size() < scene.samples.size())
        scene.targets.push_back(scene.targets.back());
    return scene;
}

void row(const std::string& cloud, const std::string& flight, const std::string& network,
         const std::string& way, const FlightResult& result) {
    std::printf(
        "| %s | %s | %s | %s | %.2f %% | %.2f %% | %.2f | %.2f | %llu | %llu | %.2f | %.2f | %llu |\n",
        cloud.c_str(), flight.c_str(), network.c_str(), way.c_str(), 100 * result.flyingError,
        100 * result.restError, result.restSeconds, static_cast<double>(result.network.bytesCarried) / 1e6,
        static_cast<unsigned long long>(result.network.requests),
        static_cast<unsigned long long>(result.session.requestsCancelled),
        static_cast<double>(result.network.bytesWasted) / 1e6,
        static_cast<double>(result.session.bytesFetchedTwice) / 1e6,
        static_cast<unsigned long long>(result.returnRequests));
    std::fflush(stdout);
}

void measure(const std::string& path, const Options& options) {
    std::string cloud = path.substr(path.find_last_of('/') + 1);
    for (const std::string& flight : options.flights) {
        FlightScene scene = sceneOf(path, flight, options);
        for (const std::string& network : options.networks)
            for (const StreamingWay& way : streamingWays(options.ways, options.budget, options.spacing))
                row(cloud, flight, network, way.name,
                    need(fly(scene, way, networkOf(network, options.connections))));
    }
}

} // namespace

int main(int argc, char** argv) {
    Options options;
    for (std::string_view name : flightNames())
        options.flights.emplace_back(name);
    CLI::App program("What a moving camera shows and costs, over simulated networks");
    program.add_option("clouds", options.clouds, ".stipple files")->required()->check(CLI::ExistingFile);
    auto list = [&](const char* name, std::vector<std::string>& values, const char* what) {
        program.add_option(name, values, what)->delimiter(',')->capture_default_str();
    };
    list("--networks", options.networks, "MBITxMS, …");
    list("--flights", options.flights, "Ways of the camera");
    list("--ways", options.ways, "Of loading");
    auto number = [&](const char* name, auto& value, const char* what, double least, double most) {
        program.add_option(name, value, what)->check(CLI::Range(least, most))->capture_default_str();
    };
    number("--seconds", options.seconds, "Of a flight", 0.1, 3600);
    number("--rest", options.rest, "Seconds at the end of which errors are taken", 0, 3600);
    number("--samples", options.samples, "Errors taken on the way", 1, 1000);
    number("--width", options.width, "Of the picture, pixels", 16, 4096);
    number("--height", options.height, "Likewise", 16, 4096);
    number("--spacing", options.spacing, "Of continuous detail, pixels", 0.1, 100);
    number("--connections", options.connections, "Of the client to the server", 1, 100);
    program.add_option("--budget", options.budget, "Points")->capture_default_str();
    CLI11_PARSE(program, argc, argv);
    std::printf("| cloud | flight | Mbit/s x ms | way | mean error flying | at rest | settled after s | MB | "
                "requests | cancelled | MB wasted | MB twice | requests of a return |\n"
                "|---|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const std::string& cloud : options.clouds)
        measure(cloud, options);
}
