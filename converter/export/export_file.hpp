// A cloud's points, or some of them, back into a file that other programs read.
#pragma once

#include "converter/build/convert.hpp"
#include "converter/export/format_sink.hpp"
#include "converter/export/walk_points.hpp"
#include "shared/base/result.hpp"
#include "shared/select/point_filter.hpp"

#include <atomic>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stipple {

// invalidArgument for an extension that is none of the formats', and where there is none.
Result<ExportFormat> exportFormatOf(const std::string& output);

struct ExportOptions {
    std::optional<ExportFormat> format = {}; // none: by the output's extension
    PointFilter filter = {};      // with a corridor, points have their station and offset in it, too
    std::uint64_t limit = 0;      // the first so many points, coarse nodes first; 0: all
    std::string polygonFile = {}; // GeoJSON in the cloud's CRS; empty: none
    // Names of the attributes to write, joined by commas (filter_text.hpp); none: all.
    std::optional<std::vector<std::string>> attributes = {};
    int threads = 0; // 0: one for each core
    // Replace an existing output of another kind. The input is never replaced.
    bool force = false;
    const std::atomic<bool>* stop = nullptr; // once true, the export ends with `cancelled`
};

struct ExportResult {
    std::string output;
    std::string format;                  // "LAS 1.4, point format 6", "PLY", …
    std::uint64_t points = 0, bytes = 0; // bytes: 0 where they went to standard output
    CloudMetadata metadata;              // of the cloud
    Grid grid;                           // that the integers of a LAS file count in; else the cloud's
    std::vector<std::string> attributes; // written
    WalkCounters counters;
    std::vector<std::string> warnings; // one sentence each
};

// Streams the points that pass the filter, node by node. Output "-" is standard output, for all formats but
// LAZ; points that have to be counted first are read twice then. The same cloud and options give the same
// bytes, for any number of threads. Nothing is left behind on failure; an older file of that name stays as it
// was. Errors: what the input is at fault for as it is; the output as writeFailed; the options as
// invalidArgument.
Result<ExportResult> exportFile(const std::string& input, const std::string& output,
                                const ExportOptions& options, const ConvertProgress& progress);

} // namespace stipple
