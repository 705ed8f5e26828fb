// `stipple synth`: a simulated scan as a LAS file.
#include "converter/synth/synthesize.hpp"
#include "shared/cli/number_check.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

namespace stipple {

namespace {

struct Arguments {
    std::string output, scene = "town";
    synth::SynthOptions options;
    bool json = false, quiet = false;
};

void print(const Arguments& arguments, const synth::SynthReport& report, double seconds) {
    double rate = static_cast<double>(report.points) / seconds;
    if (arguments.json) {
        nlohmann::json answer = {{"file", arguments.output},
                                 {"points", report.points},
                                 {"scene", arguments.scene},
                                 {"seed", arguments.options.seed},
                                 {"strips", report.strips},
                                 {"stations", report.stations},
                                 {"sideMeters", report.sideMeters},
                                 {"sceneObjects", report.sceneObjects},
                                 {"scenePrimitives", report.scenePrimitives},
                                 {"seconds", seconds},
                                 {"pointsPerSecond", rate}};
        std::printf("%s\n", answer.dump(2).c_str());
        return;
    }
    std::printf("%s: %llu points from %zu strips and %zu stations, in %.2f s (%.2f million points/s)\n",
                arguments.output.c_str(), static_cast<unsigned long long>(report.points), report.strips,
                report.stations, seconds, rate / 1e6);
}

synth::SceneKind kindOf(const std::string& name) {
    return name == "indoor"    ? synth::SceneKind::indoor
           : name == "terrain" ? synth::SceneKind::terrain
                               : synth::SceneKind::town;
}

int run(Arguments arguments) {
    arguments.options.scene = kindOf(arguments.scene);
    auto start = std::chrono::steady_clock::now();
    cli::Progress progress(arguments.quiet || arguments.json ? cli::ProgressStyle::none
                                                             : cli::ProgressStyle::text);
    auto report =
        synth::synthesize(arguments.output, arguments.options, [&](std::uint64_t done, std::uint64_t total) {
            progress.update("scan", done, total);
        });
    progress.finish();
    if (!report.ok())
        return cli::fail("synth", report.error());
    print(arguments, *report,
          std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return cli::success;
}

} // namespace

void addSynthVerb(CLI::App& program, cli::Action& action) {
    auto arguments = std::make_shared<Arguments>();
    arguments->options.threads = std::max(1u, std::thread::hardware_concurrency());
    auto* verb = program.add_subcommand(
        "synth",
        "Simulate a laser scan of a procedural scene and write it as LAS 1.4 (point format 7, UTM 32N)");
    verb->add_option("OUT", arguments->output, "The LAS file to write")->required();
    verb->add_option("--points", arguments->options.points, "How many points to write, exactly")
        ->required()
        ->check(cli::wholeNumber(0, cli::mostPoints))
        ->type_name("COUNT");
    verb->add_option("--scene", arguments->scene,
                     "town (strips and stations), indoor (stations) or terrain (strips)")
        ->check(CLI::IsMember({"town", "indoor", "terrain"}))
        ->capture_default_str();
    verb->add_option("--seed", arguments->options.seed, "Same seed, same bytes")->capture_default_str();
    verb->add_option("--threads", arguments->options.threads,
                     "Threads to use; the output does not depend on it")
        ->check(cli::wholeNumber(1, 1024))
        ->capture_default_str();
    verb->add_option("--noise", arguments->options.noiseMeters,
                     "Deviation of the range error, metres; 0: every point exactly on the surface")
        ->check(cli::number(0, 10))
        ->capture_default_str();
    verb->add_flag("--normals", arguments->options.normals,
                   "Also write the normals of the surfaces, towards the scanner: NormalX, NormalY, NormalZ");
    verb->add_flag("--json", arguments->json, "Print the report as JSON");
    verb->add_flag("--quiet", arguments->quiet, "No progress");
    verb->callback([arguments, &action] { action = [arguments] { return run(*arguments); }; });
}

} // namespace stipple
