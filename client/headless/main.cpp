// stipple: one program, verbs under it. This is the table of contents and the one place where errors end.
#include "client/headless/verbs.hpp"
#include "shared/cli/verb.hpp"

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>

using namespace stipple;

int main(int argc, char** argv) {
    std::signal(SIGXFSZ, SIG_IGN); // beyond a limit on file sizes a write fails, as on a full disk

    CLI::App program{"Stipple turns point scans into one streamable file, serves it, and draws it."};
    program.set_version_flag("--version", "stipple " STIPPLE_VERSION);
    program.require_subcommand(1);
    program.footer(
        "Exit codes: 0 success, 2 wrong usage, 3 an input is missing or damaged, 4 the output can't be\n"
        "written (or there is not enough memory), 5 verification failed, 6 the network or a server failed, "
        "130 interrupted.");

    cli::Action action;
    for (auto addVerb : headless::allVerbs())
        addVerb(program, action);

    try {
        program.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? cli::success : cli::usageError;
    }
    try {
        return action();
    } catch (const std::bad_alloc&) {
        std::fputs("stipple: there is not enough memory\n", stderr);
        return cli::outputError;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "stipple: %s\n", error.what());
        return cli::inputError;
    }
}
