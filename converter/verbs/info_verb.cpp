// stipple info FILE|URL
#include "converter/verbs/info_verb.hpp"
#include "converter/build/describe.hpp"
#include "converter/verbs/info_input.hpp"
#include "converter/verbs/info_las.hpp"
#include "converter/verbs/metadata_json.hpp"
#include "shared/cli/verb.hpp"
#include "shared/io/file_source.hpp"

#include <filesystem>
#include <fmt/format.h>
#include <memory>

namespace stipple {

namespace {
struct InfoArguments {
    std::string file;
    bool json = false, full = false;
};

double bitsPerPoint(std::uint64_t bytes, std::uint64_t points) {
    return points == 0 ? 0 : 8.0 * static_cast<double>(bytes) / static_cast<double>(points);
}
double hierarchyBytesPerNode(const CloudSummary& summary) {
    return summary.nodes == 0
               ? 0
               : static_cast<double>(summary.hierarchyBytes) / static_cast<double>(summary.nodes);
}

void printAsJson(const std::string& file, const CloudSummary& summary) {
    std::uint64_t points = summary.metadata.pointCount;
    cli::Json json = {{"file", file}, {"bytes", summary.fileBytes}, {"nodes", summary.nodes}};
    json["bytesPerPoint"] = bitsPerPoint(summary.fileBytes, points) / 8;
    json["metadataBytes"] = summary.metadataBytes;
    json["hierarchyBytes"] = summary.hierarchyBytes;
    json["hierarchyBytesPerNode"] = hierarchyBytesPerNode(summary);
    json["parts"] = cli::Json::array();
    for (const PartSummary& part : summary.parts)
        json["parts"].push_back(
            {{"name", part.name}, {"bytes", part.bytes}, {"bitsPerPoint", bitsPerPoint(part.bytes, points)}});
    json["levels"] = cli::Json::array();
    for (const LevelSummary& level : summary.levels)
        json["levels"].push_back({{"nodes", level.nodes},
                                  {"points", level.points},
                                  {"bytes", level.bytes},
                                  {"smallestNode", level.smallestNode},
                                  {"largestNode", level.largestNode}});
    json["metadata"] = cli::metadataJson(summary.metadata);
    cli::printJson(json);
}

void printAttributes(const CloudMetadata& metadata) {
    fmt::print("{:<32} {:<10} {:>16} {:>16} {:>14} {:>12}\n", "attribute", "type", "min", "max", "mean",
               "deviation");
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a) {
        const Attribute& attribute = metadata.schema.attributes[a];
        std::string type = attributeTypeName(attribute.type);
        if (attribute.components > 1)
            type += fmt::format("x{}", attribute.components);
        AttributeStatistics s;
        if (a < metadata.statistics.size())
            s = metadata.statistics[a];
        fmt::print("{:<32} {:<10} {:>16.14g} {:>16.14g} {:>14.8g} {:>12.6g}\n", attribute.name, type, s.min,
                   s.max, s.mean, s.deviation);
    }
}

void printSizes(const CloudSummary& summary) {
    fmt::print("{:>5} {:>8} {:>12} {:>14} {:>10} {:>10}\n", "level", "nodes", "points", "bytes", "smallest",
               "largest");
    for (std::size_t l = 0; l < summary.levels.size(); ++l) {
        const LevelSummary& level = summary.levels[l];
        fmt::print("{:>5} {:>8} {:>12} {:>14} {:>10} {:>10}\n", l, level.nodes, level.points, level.bytes,
                   level.smallestNode, level.largestNode);
    }
    for (const PartSummary& part : summary.parts)
        fmt::print("{:>14} bytes {:>7.2f} bits a point  {}\n", part.bytes,
                   bitsPerPoint(part.bytes, summary.metadata.pointCount), part.name);
    fmt::print("{:>14} bytes {:>7.2f} bytes a node  hierarchy\n", summary.hierarchyBytes,
               hierarchyBytesPerNode(summary));
    fmt::print("{:>14} bytes                       metadata\n", summary.metadataBytes);
}

void printAsText(const std::string& file, const CloudSummary& summary) {
    const CloudMetadata& metadata = summary.metadata;
    fmt::print("{}: \"{}\", {} points, {} bytes ({:.2f} a point)\n", file, metadata.name, metadata.pointCount,
               summary.fileBytes, bitsPerPoint(summary.fileBytes, metadata.pointCount) / 8);
    fmt::print("CRS: {}\n", cli::crsText(metadata.crs));
    BoxD bounds = metadata.worldBounds();
    for (int axis = 0; axis < 3 && !bounds.empty(); ++axis)
        fmt::print("{}: {} to {}, scale {}, offset {}\n", "xyz"[axis], bounds.min[axis], bounds.max[axis],
                   metadata.grid.scale[axis], metadata.grid.offset[axis]);
    fmt::print("root cube: 2^{} steps wide; spacing of the root {:.6g}, sampled {}; hash {}\n",
               metadata.rootCube.bits, metadata.spacing,
               samplingNames[static_cast<std::size_t>(metadata.sampling)], metadata.pointHash);
    fmt::print("picture: {}{}\n", cli::colourName(metadata.pictureColour),
               metadata.innerColour == InnerColour::mean ? ", mean colours in inner nodes" : "");
    fmt::print("made by {} ({})\n", metadata.tool, metadata.options);
    for (const SourceFile& source : metadata.sources)
        fmt::print("source: {} ({}, {} points)\n", source.name, source.format, source.pointCount);
    printAttributes(metadata);
    printSizes(summary);
}

Status printCloudInfo(ByteSource& source, const InfoArguments& arguments) {
    STIPPLE_TRY(summary, describeCloud(source, arguments.full));
    if (arguments.json)
        printAsJson(arguments.file, summary);
    else
        printAsText(arguments.file, summary);
    return {};
}

bool isAddress(const std::string& text) {
    return text.find("://") != std::string::npos;
}

// By content; an address can only be that of a cloud.
Status printAny(const InfoArguments& arguments, SourceOpener openAddress) {
    if (isAddress(arguments.file)) {
        STIPPLE_TRY(source, openAddress(arguments.file));
        return printCloudInfo(*source, arguments);
    }
    std::error_code ignored;
    if (std::filesystem::is_directory(arguments.file, ignored))
        return printInputInfo(arguments.file, arguments.json); // says that it is one
    STIPPLE_TRY(source, openFileSource(arguments.file));
    if (source->sizeBytes() == 0)
        return printInputInfo(arguments.file, arguments.json); // says that it is empty
    STIPPLE_TRY(head, readNow(*source, {0, 5}));
    std::string_view start(reinterpret_cast<const char*>(head.data()), head.size());
    if (start.starts_with("LASF"))
        return printLasInfo(arguments.file, arguments.json);
    if (start == "\x89STPL")
        return printCloudInfo(*source, arguments);
    return printInputInfo(arguments.file, arguments.json);
}

Status printInfo(const InfoArguments& arguments, SourceOpener openAddress) {
    Status printed = printAny(arguments, openAddress);
    if (!printed && printed.error().where.find(arguments.file) == std::string::npos)
        return printed.error().at(arguments.file);
    return printed;
}
} // namespace

void addInfoVerb(CLI::App& program, cli::Action& action, SourceOpener openAddress) {
    auto arguments = std::make_shared<InfoArguments>();
    CLI::App* verb = program.add_subcommand("info", "Describe a scan or a cloud");
    verb->add_option("FILE", arguments->file, "The file, or the address of a served .stipple file")
        ->required();
    verb->add_flag("--full", arguments->full,
                   "Read every node of a .stipple file, to tell bytes of positions from bytes of colour");
    verb->add_flag("--json", arguments->json, "Print one JSON object");
    verb->callback([arguments, openAddress, &action] {
        action = [arguments, openAddress]() -> int {
            Status printed = printInfo(*arguments, openAddress);
            return printed ? cli::success : cli::fail("info", printed.error());
        };
    });
}

} // namespace stipple
