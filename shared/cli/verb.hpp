// What every verb of the program `stipple` is made of. Native only.
#pragma once

#include "shared/base/result.hpp"

#include <CLI/CLI.hpp>

#include <functional>

namespace stipple::cli {

// Exit codes, as `stipple --help` and the README document them.
enum ExitCode : int {
    success = 0,
    usageError = 2,         // unknown verb or option, a value out of its range
    inputError = 3,         // an input is missing, unreadable, damaged or not understood
    outputError = 4,        // the output can't be written, or memory ran out on the way to it
    verificationFailed = 5, // `verify`: the file is readable, but is not what it should be
    networkError = 6,       // a server can't be reached or does not answer as it must
    interrupted = 130,      // Ctrl-C
};

// The code that belongs to an error; what is not told apart by its code is the fault of an input.
int exitCodeOf(const Error& error);

// Prints "stipple VERB: SENTENCE" to standard error and returns exitCodeOf(error).
int fail(const char* verb, const Error& error);

// Set by the chosen verb when its options have been parsed; main runs it. Returns an exit code.
using Action = std::function<int()>;

} // namespace stipple::cli
