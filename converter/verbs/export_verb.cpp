// stipple export FILE -o OUT
#include "converter/export/export_file.hpp"
#include "converter/export/filter_text.hpp"
#include "converter/export/text_file.hpp"
#include "converter/verbs/interrupt.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "shared/base/text.hpp"
#include "shared/cli/number_check.hpp"
#include "shared/cli/progress.hpp"
#include "shared/cli/verb.hpp"
#include "shared/select/region_json.hpp"
#include "shared/select/region_options.hpp"

#include <fmt/format.h>
#include <memory>

namespace stipple {

namespace {
struct ExportArguments {
    std::string input, output, format, box, rotatedBox, polygon, height, profile, region, classes, where;
    double width = 0;
    std::uint64_t limit = 0;
    std::vector<std::string> attributes;
    bool attributesGiven = false;
    double spacing = 0;
    int threads = 0;
    bool force = false, json = false;
};

Error inOption(const char* option, const Error& error) {
    return error.at(option);
}

// More corners than a region may have take less.
constexpr std::uint64_t maxRegionBytes = 64ull << 20;

// JSON, or the name of a file of it. Together with what the other options say.
Status addRegionOption(const std::string& given, PointFilter& filter) {
    std::size_t start = given.find_first_not_of(" \t\r\n");
    if (start != std::string::npos && given[start] == '{') {
        Status added = addRegion(filter, given);
        return added.ok() ? added : inOption("--region", added.error());
    }
    auto text = readTextFile(given, maxRegionBytes, "the region takes");
    if (!text) {
        Error error = text.error();
        if (error.code == ErrorCode::notFound)
            error.advice = "give JSON that begins with {, or a file of it";
        return inOption("--region", error);
    }
    Status added = addRegion(filter, *text);
    return added.ok() ? added : inOption("--region", added.error().at(given));
}

Status readRegion(const ExportArguments& arguments, PointFilter& filter) {
    if (!arguments.box.empty()) {
        auto box = boxFromText(arguments.box);
        if (!box)
            return inOption("--box", box.error());
        filter.box = *box;
    }
    if (!arguments.rotatedBox.empty()) {
        auto box = rotatedBoxFromText(arguments.rotatedBox);
        if (!box)
            return inOption("--rotated-box", box.error());
        filter.convex = *box;
    }
    if (!arguments.height.empty()) {
        auto heights = rangeFromText(arguments.height);
        if (!heights)
            return inOption("--height", heights.error());
        limitHeights(filter, *heights);
    }
    if (!arguments.profile.empty()) {
        auto line = lineFromText(arguments.profile);
        if (!line)
            return inOption("--profile", line.error());
        auto corridor = Corridor::make(*line, arguments.width);
        if (!corridor)
            return inOption("--profile", corridor.error());
        filter.corridor = std::make_shared<const Corridor>(*std::move(corridor));
    }
    if (!arguments.region.empty())
        STIPPLE_CHECK(addRegionOption(arguments.region, filter));
    if (filter.region && !arguments.polygon.empty())
        return Error{ErrorCode::invalidArgument, "there is another polygon", "--region",
                     "give one of the two"};
    return {};
}

Status readConditions(const ExportArguments& arguments, PointFilter& filter) {
    if (!arguments.classes.empty()) {
        auto classes = rangesFromText(arguments.classes);
        if (!classes)
            return inOption("--class", classes.error());
        filter.conditions.push_back({std::string(attribute_names::classification), *classes});
    }
    if (!arguments.where.empty()) {
        auto conditions = conditionsFromText(arguments.where);
        if (!conditions)
            return inOption("--where", conditions.error());
        filter.conditions.insert(filter.conditions.end(), conditions->begin(), conditions->end());
    }
    return {};
}

Result<ExportOptions> optionsOf(const ExportArguments& arguments) {
    ExportOptions options;
    if (!arguments.format.empty()) {
        options.format = exportFormatFromName(arguments.format);
        if (!options.format)
            return Error{ErrorCode::invalidArgument,
                         cat("\"", arguments.format, "\" is no format that can be exported"), "--format",
                         "choose las, laz, ply or csv"};
    }
    STIPPLE_CHECK(readRegion(arguments, options.filter));
    STIPPLE_CHECK(readConditions(arguments, options.filter));
    options.polygonFile = arguments.polygon;
    options.filter.spacing = arguments.spacing;
    options.limit = arguments.limit;
    if (arguments.attributesGiven)
        options.attributes = arguments.attributes;
    options.threads = arguments.threads;
    options.force = arguments.force;
    options.stop = cli::stopOnInterrupt();
    return options;
}

cli::Json tallyJson(const NodeTally& tally) {
    return {{"nodes", tally.nodes}, {"points", tally.points}, {"bytes", tally.bytes}};
}

cli::Json countersJson(const WalkCounters& counters) {
    cli::Json json = {{"whole", tallyJson(counters.whole)},     {"tested", tallyJson(counters.tested)},
                      {"outside", tallyJson(counters.outside)}, {"finer", tallyJson(counters.finer)},
                      {"absent", tallyJson(counters.absent)},   {"bytesRead", counters.bytesRead}};
    json["attributeBytesSkipped"] = counters.attributeBytesSkipped;
    json["pointsDropped"] = {{"bySpacing", counters.dropped.bySpacing},
                             {"byRegion", counters.dropped.byRegion},
                             {"byAttribute", counters.dropped.byAttribute},
                             {"byLimit", counters.droppedByLimit}};
    json["hierarchy"] = {{"chunksRead", counters.hierarchy.chunksRead},
                         {"bytesRead", counters.hierarchy.bytesRead},
                         {"chunksSkipped", counters.hierarchy.chunksSkipped},
                         {"bytesSkipped", counters.hierarchy.bytesSkipped}};
    return json;
}

cli::Json resultJson(const ExportResult& result) {
    cli::Json json = {{"output", result.output}, {"points", result.points}, {"format", result.format}};
    json["bytes"] = result.bytes;
    json["crs"] = cli::crsJson(result.metadata.crs);
    json["grid"] = cli::gridJson(result.grid);
    json["attributes"] = result.attributes;
    json["read"] = countersJson(result.counters);
    json["warnings"] = result.warnings;
    return json;
}

// On standard error where the points themselves go to standard output.
void printSummary(const ExportResult& result, std::FILE* to) {
    const WalkCounters& counters = result.counters;
    fmt::print(to, "{}: {} points of {}, {}; CRS: {}\n", result.output, result.points,
               result.metadata.pointCount, result.format, cli::crsText(result.metadata.crs));
    std::uint64_t skipped = counters.outside.nodes + counters.finer.nodes + counters.absent.nodes;
    fmt::print(to, "read {} nodes ({} bytes), {} of them point by point; skipped {} nodes",
               counters.whole.nodes + counters.tested.nodes, counters.bytesRead, counters.tested.nodes,
               skipped);
    if (counters.hierarchy.chunksSkipped > 0)
        fmt::print(to, " and {} chunks of the hierarchy", counters.hierarchy.chunksSkipped);
    fmt::print(to, "\n");
}

int runExport(const ExportArguments& arguments) {
    auto options = optionsOf(arguments);
    if (!options)
        return cli::fail("export", options.error());
    cli::Progress bar(arguments.json ? cli::ProgressStyle::none : cli::ProgressStyle::text);
    auto result = exportFile(arguments.input, arguments.output, *options,
                             [&](const std::string& phase, std::uint64_t done, std::uint64_t total) {
                                 bar.update(phase, done, total);
                             });
    bar.finish();
    if (!result)
        return cli::fail("export", result.error());
    bool toStandardOutput = arguments.output == "-";
    if (arguments.json) {
        std::string text = resultJson(*result).dump(2, ' ', false, cli::Json::error_handler_t::replace);
        fmt::print(toStandardOutput ? stderr : stdout, "{}\n", text);
        return cli::success;
    }
    for (const std::string& warning : result->warnings)
        fmt::print(stderr, "warning: {}\n", warning);
    printSummary(*result, toStandardOutput ? stderr : stdout);
    return cli::success;
}
} // namespace

void addExportVerb(CLI::App& program, cli::Action& action) {
    auto arguments = std::make_shared<ExportArguments>();
    CLI::App* verb = program.add_subcommand(
        "export", "Write the points of a .stipple file, or some of them, as LAS, LAZ, PLY or CSV");
    verb->add_option("FILE", arguments->input, "The .stipple file")->required();
    verb->add_option("-o,--output", arguments->output,
                     "The file to write; - is standard output (LAS, PLY and CSV, with --format)")
        ->required();
    verb->add_option("--format", arguments->format,
                     "las, laz, ply or csv (default: by the output's extension)");
    verb->add_option("--box", arguments->box,
                     "Points in a box: xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax, in the cloud's "
                     "coordinates; its sides belong to it");
    verb->add_option(
        "--rotated-box", arguments->rotatedBox,
        "Points in a box that is turned: its centre, its sizes and degrees counter-clockwise about z, "
        "x,y,z;dx,dy,dz;30; any height without z and dz; instead of degrees a quaternion, qx,qy,qz,qw");
    verb->add_option(
        "--polygon", arguments->polygon,
        "Points in the polygons of a GeoJSON file, in the cloud's coordinates (not longitude and "
        "latitude); edges, also those of holes, belong to them");
    verb->add_option(
        "--region", arguments->region,
        "Points in the region of a clip, as the page and the server's /points have it, as JSON or a "
        "file of it: {\"polygon\": …, \"holes\": …}, {\"line\": …, \"width\": …}, {\"prism\": …} (a "
        "polygon on the screen) or {\"box\": …}, also several of these, and \"heights\": [low, high]");
    verb->add_option("--height", arguments->height, "Points between two heights: 10..20, 10.. or ..20");
    CLI::Option* profile = verb->add_option("--profile", arguments->profile,
                                            "Points along a line, x,y;x,y;…, within half of --width of it, "
                                            "with two attributes more: Station (along the "
                                            "line) and Offset (positive to its left)");
    CLI::Option* width =
        verb->add_option("--width", arguments->width, "The width of the profile")->check(cli::numberAbove(0));
    profile->needs(width);
    width->needs(profile);
    verb->add_option(
            "--spacing", arguments->spacing,
            "A level of detail: points of the levels whose minimum distance is at least this, in the "
            "cloud's units. Leaves among them, which hold the rest of their points at any distance, "
            "are thinned to it, and so is the root if its distance is smaller: no two points of a node are "
            "nearer. "
            "Other options choose among these points")
        ->check(cli::numberAbove(0));
    verb->add_option("--class", arguments->classes, "Points of these classes: 2,6 or 3-5, or both");
    verb->add_option(
        "--where", arguments->where,
        "Points whose values are in ranges: \"Intensity:100..2000;Return Number:1,3..\"; of scaled "
        "attributes the values they mean");
    verb->add_option("--limit", arguments->limit,
                     "The first so many of these points; coarse nodes come first")
        ->check(cli::wholeNumber(1, cli::mostPoints));
    CLI::Option* attributes =
        verb->add_option("--attributes", arguments->attributes,
                         "Write these attributes only, names joined by commas (none: \"\")")
            ->delimiter('\n')
            ->allow_extra_args(false);
    verb->add_option("--threads", arguments->threads, "Threads to use (default: one for each core)")
        ->check(cli::wholeNumber(1, 1024));
    verb->add_flag("--force", arguments->force, "Replace an existing output even if it is of another kind");
    verb->add_flag("--json", arguments->json, "Print the result as one JSON object; no progress");
    verb->footer(
        "CSV has exact decimals: coordinates as many places as the grid needs, scaled attributes as the\n"
        "values they mean, an empty field for no value. PLY is binary: x, y, z in double, attributes in\n"
        "their own types, scaled ones as double. LAS keeps the integers.");
    verb->callback([arguments, attributes, &action] {
        arguments->attributesGiven = attributes->count() > 0;
        action = [arguments] { return runExport(*arguments); };
    });
}

} // namespace stipple
