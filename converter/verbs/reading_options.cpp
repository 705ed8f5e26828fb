#include "converter/verbs/reading_options.hpp"

#include "converter/build/memory_share.hpp"
#include "shared/cli/number_check.hpp"

namespace stipple::cli {

void addReadingOptions(CLI::App& verb, InputOptions& reading) {
    verb.add_option("--columns", reading.columns,
                    "Columns of text files, for example \"x,y,z,intensity,-,classification\"; - skips one");
    verb.add_option("--scale", reading.scale,
                    "Grid step for inputs of floating-point coordinates (default: by what they hold)")
        ->check(cli::numberAbove(0));
}

void addResourceOptions(CLI::App& verb, int& threads, std::uint64_t& memoryBytes) {
    verb.add_option("--threads", threads, "Threads to use (default: one for each core)")
        ->check(cli::wholeNumber(1, 1024));
    verb.add_option("--memory", memoryBytes,
                    "Memory to use, for example 2G; what does not fit goes to disk (default: a quarter of "
                    "the machine's)")
        ->transform(cli::memorySize(leastMemoryBytes, std::uint64_t{1} << 50));
}

} // namespace stipple::cli
