// The ways of loading that streaming_bench and flight_bench compare, and what both read from their command
// lines. What can't be had ends the program with a sentence.
#pragma once

#include "tests/bench/streaming_run.hpp"

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace stipple::test {

inline void need(const Status& status) {
    if (!status.ok()) {
        std::fprintf(stderr, "%s\n", status.error().sentence().c_str());
        std::exit(1);
    }
}
template <class T>
T need(Result<T> result) {
    if (!result.ok())
        need(Status(result.error()));
    return std::move(*result);
}

// Those of these names: `all` with everything on, `plain` with everything off, and with everything but one
// thing.
std::vector<StreamingWay> streamingWays(const std::vector<std::string>& names, std::uint64_t budget,
                                        double spacing);

// Of "MBITxMS".
NetworkOptions networkOf(const std::string& text, int connections);

// A file as a server has it.
std::shared_ptr<const HostedFile> hosted(const std::string& path);

} // namespace stipple::test
