// The verb `info`. How an address is read is for the program to know: the converter reads files.
#pragma once

#include "shared/cli/verb.hpp"
#include "shared/io/byte_source.hpp"

#include <memory>
#include <string>

namespace stipple {

using SourceOpener = Result<std::unique_ptr<ByteSource>> (*)(const std::string& address);

void addInfoVerb(CLI::App& program, cli::Action& action, SourceOpener openAddress);

} // namespace stipple
