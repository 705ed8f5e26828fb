#include "server/verbs/serving.hpp"
#include "server/verbs/view_inputs.hpp"

#include <csignal>
#include <memory>
#include <spawn.h>

extern char** environ;

namespace stipple {

namespace {

std::atomic<bool> stopRequested{false};

// Not waited for: the browser may live longer than the server.
void openBrowser(const std::string& address) {
    std::string program = "xdg-open", argument = address;
    char* arguments[] = {program.data(), argument.data(), nullptr};
    pid_t child = 0;
    if (::posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
        std::fprintf(stderr, "stipple view: xdg-open can't be run; open %s yourself\n", address.c_str());
}

int view(const server::ServingOptions& options, const std::vector<std::string>& inputs, bool opensBrowser) {
    std::signal(SIGINT, [](int) { stopRequested = true; });
    std::vector<std::string> paths;
    for (const std::string& input : inputs) {
        auto path = server::prepareInput(input, stopRequested);
        if (!path)
            return cli::fail("view", path.error());
        paths.push_back(*path);
    }
    std::signal(SIGINT, SIG_DFL);
    return server::serveUntilSignalled("view", options, paths, [&](const std::string& address) {
        if (opensBrowser)
            openBrowser(address);
    });
}

} // namespace

void addViewVerb(CLI::App& program, cli::Action& action) {
    struct Options {
        server::ServingOptions serving;
        std::vector<std::string> inputs;
        bool opensBrowser = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* verb = program.add_subcommand("view", "Convert scans if needed, serve them, print the address");
    verb->add_option("FILE", options->inputs,
                     "Scans of any kind that convert reads, .stipple files, or folders of .stipple files")
        ->required();
    verb->add_flag("--open", options->opensBrowser, "Open the address in the browser");
    server::addServingOptions(*verb, options->serving);
    verb->footer(
        "scan.las is converted to scan.stipple beside it (or scan.las.stipple, if that one was made of\n"
        "another; in a temporary folder if theirs can't be written), and only again once it is newer.\n"
        "Example: stipple view scan.las --open");
    verb->callback([options, &action] {
        action = [options] { return view(options->serving, options->inputs, options->opensBrowser); };
    });
}

} // namespace stipple
