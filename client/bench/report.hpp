// What `stipple bench` writes. Pure: results in, text out.
#pragma once

#include "client/bench/results.hpp"
#include "shared/base/result.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace stipple::bench {

// Everything but the pictures: machine, options, modes, clouds with the cameras of their paths, every frame
// of every run, summaries. Names of fields are those of results.hpp.
nlohmann::json toJson(const BenchResult& result);

// A line for each frame, with a line of names before them.
std::string csvOf(const BenchResult& result);

// One page with all of it, charts and pictures included; it asks for no other file. Error: that of coding a
// picture.
Result<std::string> htmlOf(const BenchResult& result);

} // namespace stipple::bench
