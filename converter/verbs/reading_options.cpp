#include "converter/verbs/reading_options.hpp"

namespace stipple::cli {

void addReadingOptions(CLI::App& verb, InputOptions& reading) {
    verb.add_option("--columns", reading.columns,
                    "Columns of text files, for example \"x,y,z,intensity,-,classification\"; - skips one");
    verb.add_option("--scale", reading.scale,
                    "Grid step for inputs of floating-point coordinates (default: by what they hold)")
        ->check(CLI::PositiveNumber);
}

} // namespace stipple::cli
