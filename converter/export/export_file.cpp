#include "converter/export/export_file.hpp"

#include "converter/build/output_check.hpp"
#include "converter/build/parallel.hpp"
#include "converter/export/csv_sink.hpp"
#include "converter/export/filter_text.hpp"
#include "converter/export/geojson.hpp"
#include "converter/export/las_sink.hpp"
#include "converter/export/ply_sink.hpp"
#include "converter/export/polygon_crs.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"

#include <array>
#include <filesystem>
#include <numeric>

namespace stipple {

namespace {

struct FormatRow {
    ExportFormat format;
    const char* name;
    const char* extension;
    const char* magic; // how such files begin
};
constexpr std::array<FormatRow, 4> formats{{{ExportFormat::las, "LAS", "las", "LASF"},
                                            {ExportFormat::laz, "LAZ", "laz", "LASF"},
                                            {ExportFormat::ply, "PLY", "ply", "ply"},
                                            {ExportFormat::csv, "CSV", "csv", "X,Y,Z"}}};

const FormatRow& rowOf(ExportFormat format) {
    return formats[static_cast<std::size_t>(format)];
}

std::string lowerCase(std::string_view text) {
    std::string lower;
    for (char c : text)
        lower += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower;
}

bool isStandardOutput(const std::string& output) {
    return output == "-";
}

class Export {
  public:
    Export(const std::string& input, const std::string& output, const ExportOptions& options,
           const ConvertProgress& progress)
        : input_(input), output_(output), options_(options), progress_(progress) {}

    Result<ExportResult> run() {
        STIPPLE_CHECK(chooseFormat());
        if (!isStandardOutput(output_))
            STIPPLE_CHECK(checkOutput({input_}, output_, options_.force, rowOf(format_).magic));
        STIPPLE_TRY(source, openFileSource(input_));
        auto opened = CloudReader::open(*source);
        if (!opened)
            return opened.error().where.find(input_) == std::string::npos ? opened.error().at(input_)
                                                                          : opened.error();
        CloudReader& reader = **opened;
        result_.metadata = reader.metadata();
        result_.grid = result_.metadata.grid;
        result_.output = output_;
        STIPPLE_TRY(filter, makeFilter());
        STIPPLE_TRY(attributes, chooseAttributes());
        STIPPLE_CHECK(write(reader, filter, {result_.metadata, attributes}));
        return std::move(result_);
    }

  private:
    Status chooseFormat() {
        if (options_.format) {
            format_ = *options_.format;
        } else if (isStandardOutput(output_)) {
            return Error{ErrorCode::invalidArgument, "standard output has no extension to tell the format by",
                         "", "give --format ply or csv"};
        } else {
            STIPPLE_TRY(format, exportFormatOf(output_));
            format_ = format;
        }
        bool streams = format_ == ExportFormat::ply || format_ == ExportFormat::csv;
        if (isStandardOutput(output_) && !streams)
            return Error{ErrorCode::invalidArgument,
                         cat("a ", rowOf(format_).name,
                             " file can't go to standard output, for its header is written last"),
                         "", "write to a file, or choose PLY or CSV"};
        return {};
    }

    Result<CloudFilter> makeFilter() {
        PointFilter filter = options_.filter;
        if (!options_.polygonFile.empty()) {
            STIPPLE_TRY(polygons, readGeoJson(options_.polygonFile));
            Status same = checkPolygonCrs(result_.metadata.crs, polygons.crs, result_.warnings);
            if (!same)
                return same.error().at(options_.polygonFile);
            filter.region = polygons.region;
        }
        return CloudFilter::make(result_.metadata, filter);
    }

    Result<std::vector<int>> chooseAttributes() {
        const Schema& schema = result_.metadata.schema;
        std::vector<int> attributes(schema.attributes.size());
        std::iota(attributes.begin(), attributes.end(), 0);
        if (options_.attributes) {
            STIPPLE_TRY(chosen, attributesFromTexts(schema, *options_.attributes));
            attributes = std::move(chosen);
        }
        for (int attribute : attributes)
            result_.attributes.push_back(schema.attributes[static_cast<std::size_t>(attribute)].name);
        return attributes;
    }

    WalkOptions walkOptions(const char* phase, bool whole) const {
        WalkOptions walk;
        walk.threads = threadCount(options_.threads);
        walk.stop = options_.stop;
        // How many points a filter leaves to read is not known before.
        std::uint64_t total = whole ? result_.metadata.pointCount : 0;
        walk.progress = [this, phase, total](std::uint64_t points) { progress_(phase, points, total); };
        return walk;
    }

    Status write(CloudReader& reader, const CloudFilter& filter, const SinkInput& input) {
        result_.format = rowOf(format_).name;
        if (format_ == ExportFormat::las || format_ == ExportFormat::laz) {
            STIPPLE_TRY(sink, LasSink::create(output_, input, filter.reach(), result_.metadata.pointCount,
                                              format_ == ExportFormat::laz));
            for (const std::string& warning : sink->warnings())
                result_.warnings.push_back(warning);
            STIPPLE_CHECK(walk(reader, filter, input, *sink));
            const las::Header& header = sink->header();
            result_.format = cat(rowOf(format_).name, " ", header.versionMajor, ".", header.versionMinor,
                                 ", point format ", header.pointFormat);
            result_.grid = header.grid;
        } else {
            STIPPLE_TRY(sink, makeStream(reader, filter, input));
            STIPPLE_CHECK(walk(reader, filter, input, *sink));
        }
        std::error_code none;
        if (!isStandardOutput(output_))
            result_.bytes = std::filesystem::file_size(output_, none);
        return {};
    }

    Result<std::unique_ptr<PointSink>> makeStream(CloudReader& reader, const CloudFilter& filter,
                                                  const SinkInput& input) {
        std::unique_ptr<ByteSink> bytes;
        if (isStandardOutput(output_)) {
            bytes = standardOutputSink();
        } else {
            STIPPLE_TRY(file, fileSink(output_));
            bytes = std::move(file);
        }
        if (format_ == ExportFormat::csv)
            return csvSink(std::move(bytes), input);
        std::optional<std::uint64_t> count;
        if (filter.wantsEverything() || !bytes->canOverwrite()) {
            STIPPLE_TRY(counted, countPoints(reader, input_, filter, walkOptions("count", false)));
            count = counted;
        }
        return plySink(std::move(bytes), input, count);
    }

    Status walk(CloudReader& reader, const CloudFilter& filter, const SinkInput& input, PointSink& sink) {
        STIPPLE_TRY(counters, walkPoints(reader, input_, filter, input.attributes, sink,
                                         walkOptions("export", filter.wantsEverything())));
        STIPPLE_CHECK(sink.finish());
        result_.counters = counters;
        result_.points = counters.pointsTaken;
        if (filter.wantsEverything() && result_.points != result_.metadata.pointCount)
            result_.warnings.push_back(cat("the cloud says it has ", result_.metadata.pointCount,
                                           " points, but its nodes hold ", result_.points));
        return {};
    }

    const std::string& input_;
    const std::string& output_;
    const ExportOptions& options_;
    const ConvertProgress& progress_;
    ExportFormat format_ = ExportFormat::las;
    ExportResult result_;
};

} // namespace

const char* exportFormatName(ExportFormat format) {
    return rowOf(format).name;
}

std::optional<ExportFormat> exportFormatFromName(std::string_view name) {
    for (const FormatRow& row : formats)
        if (lowerCase(name) == row.extension)
            return row.format;
    return std::nullopt;
}

Result<ExportFormat> exportFormatOf(const std::string& output) {
    std::string extension = std::filesystem::path(output).extension().string();
    if (auto format = exportFormatFromName(extension.empty() ? "" : extension.substr(1)))
        return *format;
    return Error{ErrorCode::invalidArgument,
                 extension.empty() ? "the output has no extension to tell the format by"
                                   : cat("\"", extension, "\" is no format that can be exported"),
                 output, "use .las, .laz, .ply or .csv, or give --format"};
}

Result<ExportResult> exportFile(const std::string& input, const std::string& output,
                                const ExportOptions& options, const ConvertProgress& progress) {
    return Export(input, output, options, progress).run();
}

} // namespace stipple
