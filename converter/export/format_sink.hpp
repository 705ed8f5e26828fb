// Points as a file of some format, into any sink of bytes: what the format has to know before its first byte
// goes out, and the sink that writes it.
#pragma once

#include "converter/export/walk_points.hpp"
#include "shared/io/byte_sink.hpp"
#include "shared/sinks/las_sink.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace stipple {

enum class ExportFormat : std::uint8_t { las, laz, ply, csv };

const char* exportFormatName(ExportFormat format);      // "LAS", …
const char* exportFormatExtension(ExportFormat format); // "las", …
// "las", "LAZ", …; nothing for others.
std::optional<ExportFormat> exportFormatFromName(std::string_view name);
// Does it begin with what is known only at the end, even if the points are counted before? (LAZ: where its
// chunk table is. LASzip also reads files that say so in their last bytes, but laz-perf, and what is built on
// it, does not.)
bool needsOverwriting(ExportFormat format);

// What has to be known before.
struct FormatPlan {
    ExportFormat format = ExportFormat::las;
    std::optional<std::uint64_t> pointCount; // where it had to be found out, or costs nothing
    std::optional<LasPlan> las;              // of LAS and LAZ
    std::optional<las::PointSummary> lasSummary;
};

// `toBeOverwritten`: will the sink's bytes be ones that can be written again? Where they can't, the points
// are walked once more than they are written, reading no more of them than the format's first bytes need; for
// CSV nothing is. invalidArgument if the format can't do without.
Result<FormatPlan> planFormat(ExportFormat format, bool toBeOverwritten, CloudReader& reader,
                              const std::string& name, const CloudFilter& filter, const SinkInput& input,
                              const WalkOptions& options);

struct FormatSink {
    std::unique_ptr<PointSink> sink;
    const LasSink* las = nullptr; // the sink, of LAS and LAZ
};

// Puts the format's first bytes into `to`. `input` is that of the plan.
Result<FormatSink> openFormatSink(const FormatPlan& plan, std::unique_ptr<ByteSink> to,
                                  const SinkInput& input);

} // namespace stipple
