// A cloud's points back into a LAS file.
#pragma once

#include "converter/build/convert.hpp"
#include "shared/las/las_header.hpp"

namespace stipple {

struct ExportResult {
    std::string output;
    std::uint64_t points = 0;
    las::Header header; // of the file written
    std::vector<std::string> warnings;
};

// Streams every point, node by node, with its exact integers and all attributes; the cloud's CRS goes in as
// WKT. The point format is that of the sources where they had one in common, else the smallest that holds all
// attributes. Where integers exceed 32 bits they are counted from another offset; outOfRange if the cloud is
// too wide for that as well.
Result<ExportResult> exportLas(const std::string& input, const std::string& output, bool force,
                               const std::atomic<bool>* stop, const ConvertProgress& progress);

} // namespace stipple
