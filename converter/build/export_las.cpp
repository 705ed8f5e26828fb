#include "converter/build/export_las.hpp"

#include "converter/build/output_check.hpp"
#include "converter/build/scan.hpp"
#include "shared/base/text.hpp"
#include "shared/format/cloud_file.hpp"
#include "shared/io/file_source.hpp"
#include "shared/las/las_writer.hpp"

#include <charconv>
#include <limits>

namespace stipple {

namespace {
constexpr std::int64_t lowest = std::numeric_limits<std::int32_t>::min();
constexpr std::int64_t highest = std::numeric_limits<std::int32_t>::max();
// Shifts are multiples of this many steps, so that offsets stay round decimal numbers.
constexpr std::int64_t shiftUnit = 1'000'000;

// What to subtract from the integers so that they fit 32 bits; 0 on axes where they do.
Result<Vec3i> shiftInto32Bits(const BoxI& bounds) {
    Vec3i shift;
    for (int axis = 0; axis < 3 && !bounds.empty(); ++axis) {
        std::int64_t low = bounds.min[axis], high = bounds.max[axis];
        if (low >= lowest && high <= highest)
            continue;
        shift[axis] = (low / 2 + high / 2) / shiftUnit * shiftUnit;
        if (low - shift[axis] < lowest || high - shift[axis] > highest)
            return Error{
                ErrorCode::outOfRange,
                cat("the cloud spans more grid steps in ", "xyz"[axis], " than a LAS file can count (2^32)"),
                "", "export a part of it"};
    }
    return shift;
}

// The point format in the text of a source: "LAS 1.2, point format 2"; -1 if there is none.
int statedPointFormat(const std::string& format) {
    constexpr std::string_view before = "point format ";
    std::size_t at = format.find(before);
    int number = -1;
    if (at != std::string::npos)
        std::from_chars(format.data() + at + before.size(), format.data() + format.size(), number);
    return number <= 10 ? number : -1;
}

int commonPointFormat(const std::vector<SourceFile>& sources) {
    int common = sources.empty() ? -1 : statedPointFormat(sources[0].format);
    for (const SourceFile& source : sources)
        if (statedPointFormat(source.format) != common)
            return -1;
    return common;
}

las::WriterOptions writerOptions(const CloudMetadata& metadata, Vec3i shift) {
    las::WriterOptions options;
    options.grid = metadata.grid;
    for (int axis = 0; axis < 3; ++axis)
        if (shift[axis] != 0)
            options.grid.offset[axis] = metadata.grid.toWorld(shift)[axis];
    options.schema = metadata.schema;
    options.pointFormat = commonPointFormat(metadata.sources);
    options.expectedPoints = metadata.pointCount;
    options.wkt = metadata.crs.wkt;
    int gpsTime = metadata.schema.find(attribute_names::gpsTime);
    if (gpsTime >= 0 &&
        metadata.schema.attributes[static_cast<std::size_t>(gpsTime)].description == standardGpsTimeText)
        options.globalEncoding = 1;
    return options;
}
} // namespace

Result<ExportResult> exportLas(const std::string& input, const std::string& output, bool force,
                               const std::atomic<bool>* stop, const ConvertProgress& progress) {
    STIPPLE_CHECK(checkOutput({input}, output, force, "LASF"));
    STIPPLE_TRY(source, openFileSource(input));
    STIPPLE_TRY(reader, CloudReader::open(*source));
    const CloudMetadata& metadata = reader->metadata();
    STIPPLE_TRY(shift, shiftInto32Bits(metadata.bounds));
    STIPPLE_TRY(writer, las::Writer::create(output, writerOptions(metadata, shift)));

    ExportResult result;
    result.output = output;
    STIPPLE_CHECK(reader->visitNodes([&](const NodeEntry& entry) -> Status {
        if (stop && *stop)
            return Error{ErrorCode::cancelled, "interrupted", "", ""};
        STIPPLE_TRY(batch, reader->readNode(entry));
        for (Vec3i& position : batch.positions)
            position = position - shift;
        if (Status written = writer->write(batch); !written)
            return written.error();
        result.points += batch.size();
        progress("export", result.points, metadata.pointCount);
        return {};
    }));
    STIPPLE_CHECK(writer->finish());
    result.header = writer->header();
    result.warnings = writer->warnings();
    if (metadata.crs.known() && metadata.crs.wkt.empty())
        result.warnings.push_back(
            "the cloud's CRS is known by its EPSG code alone, which LAS 1.4 has no field for");
    return result;
}

} // namespace stipple
