#include "converter/export/export_file.hpp"

#include "converter/build/output_check.hpp"
#include "converter/export/filter_text.hpp"
#include "converter/export/geojson.hpp"
#include "converter/export/polygon_crs.hpp"
#include "converter/export/standard_output.hpp"
#include "converter/parallel/parallel.hpp"
#include "shared/base/text.hpp"
#include "shared/io/file_source.hpp"
#include "shared/select/corridor_attributes.hpp"

#include <filesystem>
#include <numeric>

namespace stipple {

namespace {

// How files of a format begin.
const char* magicOf(ExportFormat format) {
    switch (format) {
    case ExportFormat::ply:
        return "ply";
    case ExportFormat::csv:
        return "X,Y,Z";
    default:
        return "LASF";
    }
}

bool isStandardOutput(const std::string& output) {
    return output == "-";
}

class Export {
  public:
    Export(const std::string& input, const std::string& output, const ExportOptions& options,
           const ConvertProgress& progress)
        : input_(input), output_(output), options_(options), gate_(options.stop), progress_(progress) {}

    Result<ExportResult> run() {
        STIPPLE_CHECK(chooseFormat());
        if (!isStandardOutput(output_))
            STIPPLE_CHECK(checkOutput({input_}, output_, options_.force, magicOf(format_)));
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
        CloudMetadata metadata = result_.metadata;
        if (options_.filter.corridor) {
            auto stored = static_cast<int>(metadata.schema.attributes.size());
            addCorridorAttributes(metadata);
            for (int derived : {stored, stored + 1})
                attributes.push_back(derived);
        }
        for (int attribute : attributes)
            result_.attributes.push_back(
                metadata.schema.attributes[static_cast<std::size_t>(attribute)].name);
        STIPPLE_CHECK(write(reader, filter, {metadata, attributes}));
        return std::move(result_);
    }

  private:
    Status chooseFormat() {
        if (options_.format) {
            format_ = *options_.format;
        } else if (isStandardOutput(output_)) {
            return Error{ErrorCode::invalidArgument, "standard output has no extension to tell the format by",
                         "", "give --format las, ply or csv"};
        } else {
            STIPPLE_TRY(format, exportFormatOf(output_));
            format_ = format;
        }
        if (isStandardOutput(output_) && needsOverwriting(format_))
            return Error{ErrorCode::invalidArgument,
                         cat("a ", exportFormatName(format_),
                             " file can't go to standard output, for its beginning is written last"),
                         "", "write to a file, or choose LAS, PLY or CSV"};
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
        return attributes;
    }

    WalkOptions walkOptions(const char* phase, bool whole) const {
        WalkOptions walk;
        walk.threads = threadCount(options_.threads);
        walk.gate = &gate_;
        walk.limit = options_.limit;
        // How many points a filter leaves to read is not known before.
        std::uint64_t total = whole ? result_.metadata.pointCount : 0;
        walk.progress = [this, phase, total](std::uint64_t points) { progress_(phase, points, total); };
        return walk;
    }

    Status write(CloudReader& reader, const CloudFilter& filter, const SinkInput& input) {
        STIPPLE_TRY(plan, planFormat(format_, !isStandardOutput(output_), reader, input_, filter, input,
                                     walkOptions("count", false)));
        STIPPLE_TRY(bytes, openOutput());
        STIPPLE_TRY(to, openFormatSink(plan, std::move(bytes), input));
        result_.format = exportFormatName(format_);
        if (to.las)
            for (const std::string& warning : to.las->warnings())
                result_.warnings.push_back(warning);
        STIPPLE_CHECK(walk(reader, filter, input, *to.sink));
        if (to.las) {
            const las::Header& header = to.las->header();
            result_.format = cat(exportFormatName(format_), " ", header.versionMajor, ".",
                                 header.versionMinor, ", point format ", header.pointFormat);
            result_.grid = header.grid;
        }
        std::error_code none;
        if (!isStandardOutput(output_))
            result_.bytes = std::filesystem::file_size(output_, none);
        return {};
    }

    Result<std::unique_ptr<ByteSink>> openOutput() {
        if (isStandardOutput(output_))
            return standardOutputSink();
        return fileSink(output_);
    }

    Status walk(CloudReader& reader, const CloudFilter& filter, const SinkInput& input, PointSink& sink) {
        STIPPLE_TRY(counters, walkPoints(reader, input_, filter, input.attributes, sink,
                                         walkOptions("export", filter.wantsEverything())));
        STIPPLE_CHECK(sink.finish());
        result_.counters = counters;
        result_.points = counters.pointsTaken;
        if (filter.wantsEverything() && options_.limit == 0 && result_.points != result_.metadata.pointCount)
            result_.warnings.push_back(cat("the cloud says it has ", result_.metadata.pointCount,
                                           " points, but its nodes hold ", result_.points));
        return {};
    }

    const std::string& input_;
    const std::string& output_;
    const ExportOptions& options_;
    const StopGate gate_;
    const ConvertProgress& progress_;
    ExportFormat format_ = ExportFormat::las;
    ExportResult result_;
};

} // namespace

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
