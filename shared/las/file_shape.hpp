// What a writer's options make of a file before any point is there: point format, version, and where in a
// record each column goes.
#pragma once

#include "shared/las/las_writer.hpp"
#include "shared/las/record_codec.hpp"
#include "shared/las/record_layout.hpp"

#include <cstdint>
#include <limits>
#include <vector>

namespace stipple::las {

inline constexpr std::size_t maxVlrData = 65535; // of a record before the points
// The most points that LAS 1.0-1.3 count.
inline constexpr std::uint64_t maxLegacyCount = std::numeric_limits<std::uint32_t>::max();

// How the columns of a schema become records.
struct RecordPlan {
    RecordLayout layout;
    std::vector<ColumnField> columns;
    std::vector<std::size_t> described; // schema indices of the extra bytes that get a descriptor
};

struct FileShape {
    RecordPlan plan;
    int pointFormat = 0, versionMinor = 0;
};

// invalidArgument for options that contradict themselves or LAS.
Result<FileShape> shapeOf(const WriterOptions& options);

SummaryColumns summaryColumns(const RecordPlan& plan, const Schema& schema, int pointFormat);

} // namespace stipple::las
