// The verbs of the program, in the order `--help` shows them.
#pragma once

#include "shared/cli/verb.hpp"

#include <vector>

namespace stipple::headless {

using AddVerb = void (*)(CLI::App& program, cli::Action& action);

std::vector<AddVerb> allVerbs();

} // namespace stipple::headless
