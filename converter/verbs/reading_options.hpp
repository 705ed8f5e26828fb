// The options of verbs that read scans: what a file may leave to its user, and what reading may take.
#pragma once

#include "converter/input/open.hpp"
#include "shared/cli/verb.hpp"

namespace stipple::cli {

// Adds --columns and --scale to the verb. `reading` is filled when the command line is parsed; it must live
// until then.
void addReadingOptions(CLI::App& verb, InputOptions& reading);

// Adds --threads and --memory, for points; the same terms.
void addResourceOptions(CLI::App& verb, int& threads, std::uint64_t& memoryBytes);

} // namespace stipple::cli
