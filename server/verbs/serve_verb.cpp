#include "server/verbs/serving.hpp"

#include <memory>

namespace stipple {

void addServeVerb(CLI::App& program, cli::Action& action) {
    struct Options {
        server::ServingOptions serving;
        std::vector<std::string> paths;
    };
    auto options = std::make_shared<Options>();
    options->serving.reloadsOnHangUp = true;
    CLI::App* verb = program.add_subcommand("serve", "Serve the page and clouds over HTTP");
    verb->add_option(
            "PATH", options->paths,
            ".stipple files, folders that hold some, or http(s) addresses of .stipple files at other "
            "servers that answer byte ranges")
        ->required();
    server::addServingOptions(*verb, options->serving);
    verb->footer("Addresses: / the page, /api/v1/clouds the list, /api/v1/clouds/ID one cloud's metadata,\n"
                 "/clouds/ID.stipple its file, in byte ranges;\n"
                 "/api/v1/clouds/ID/points, /profile and /nearest its points (docs/API.md).\n"
                 "Example: stipple serve scans/ https://maps.example/clouds/town.stipple --port 8017");
    verb->callback([options, &action] {
        action = [options] {
            return server::serveUntilSignalled("serve", options->serving, options->paths,
                                               [](const std::string&) {});
        };
    });
}

} // namespace stipple
