// The options of verbs that read scans: what a file may leave to its user.
#pragma once

#include "converter/input/open.hpp"
#include "shared/cli/verb.hpp"

namespace stipple::cli {

// Adds --columns and --scale to the verb. `reading` is filled when the command line is parsed; it must live
// until then.
void addReadingOptions(CLI::App& verb, InputOptions& reading);

} // namespace stipple::cli
