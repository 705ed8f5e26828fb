#include "converter/export/format_sink.hpp"

#include "converter/crs/crs.hpp"
#include "converter/export/las_summary.hpp"
#include "converter/export/parallel_chunks.hpp"
#include "converter/export/ply_sink.hpp"
#include "shared/base/text.hpp"
#include "shared/sinks/csv_sink.hpp"

#include <algorithm>
#include <array>

namespace stipple {

namespace {

struct FormatRow {
    ExportFormat format;
    const char* name;
    const char* extension;
};
constexpr std::array<FormatRow, 4> formats{{{ExportFormat::las, "LAS", "las"},
                                            {ExportFormat::laz, "LAZ", "laz"},
                                            {ExportFormat::ply, "PLY", "ply"},
                                            {ExportFormat::csv, "CSV", "csv"}}};

const FormatRow& rowOf(ExportFormat format) {
    return formats[static_cast<std::size_t>(format)];
}

std::string lowerCase(std::string_view text) {
    std::string lower;
    for (char c : text)
        lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower;
}

} // namespace

const char* exportFormatName(ExportFormat format) {
    return rowOf(format).name;
}

const char* exportFormatExtension(ExportFormat format) {
    return rowOf(format).extension;
}

std::optional<ExportFormat> exportFormatFromName(std::string_view name) {
    for (const FormatRow& row : formats)
        if (lowerCase(name) == row.extension)
            return row.format;
    return std::nullopt;
}

bool needsOverwriting(ExportFormat format) {
    return format == ExportFormat::laz;
}

Result<FormatPlan> planFormat(ExportFormat format, bool toBeOverwritten, CloudReader& reader,
                              const std::string& name, const CloudFilter& filter, const SinkInput& input,
                              const WalkOptions& options) {
    if (needsOverwriting(format) && !toBeOverwritten)
        return Error{ErrorCode::invalidArgument,
                     cat("a ", exportFormatName(format), " file begins with what is known only at its end"),
                     "", "write to a file, or choose another format"};
    FormatPlan plan;
    plan.format = format;
    if (format == ExportFormat::las || format == ExportFormat::laz) {
        STIPPLE_TRY(las, LasPlan::make(input, filter.reach(), input.metadata.pointCount,
                                       format == ExportFormat::laz, wktOfEpsg));
        plan.las = std::move(las);
        plan.las->options.makeChunkWork = parallelChunks(options.threads);
        if (!toBeOverwritten) {
            STIPPLE_TRY(summary, summarizeForLas(reader, name, filter, input, *plan.las, options));
            plan.pointCount = summary.pointCount;
            plan.lasSummary = std::move(summary);
        }
    } else if (format == ExportFormat::ply && !toBeOverwritten) {
        STIPPLE_TRY(count, countPoints(reader, name, filter, options));
        plan.pointCount = count;
    }
    if (!plan.pointCount && filter.wantsEverything())
        plan.pointCount = options.limit > 0 ? std::min(options.limit, input.metadata.pointCount)
                                            : input.metadata.pointCount;
    return plan;
}

Result<FormatSink> openFormatSink(const FormatPlan& plan, std::unique_ptr<ByteSink> to,
                                  const SinkInput& input) {
    FormatSink made;
    if (plan.las) {
        STIPPLE_TRY(sink, LasSink::create(std::move(to), *plan.las, plan.lasSummary));
        made.las = sink.get();
        made.sink = std::move(sink);
    } else if (plan.format == ExportFormat::ply) {
        STIPPLE_TRY(sink, plySink(std::move(to), input, plan.pointCount));
        made.sink = std::move(sink);
    } else {
        STIPPLE_TRY(sink, csvSink(std::move(to), input));
        made.sink = std::move(sink);
    }
    return made;
}

} // namespace stipple
