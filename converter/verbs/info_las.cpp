#include "converter/verbs/info_las.hpp"

#include "converter/crs/crs.hpp"
#include "converter/input/las_input.hpp"
#include "converter/verbs/metadata_json.hpp"

#include <fmt/format.h>

namespace stipple {

namespace {
struct LasInfo {
    OpenLas input;
    Crs crs;
    std::vector<std::string> warnings;

    const las::Header& header() const { return input.reader->header(); }
};

Result<LasInfo> readLasInfo(const std::string& path) {
    STIPPLE_TRY(input, openLas(path));
    STIPPLE_TRY(reading, crsOfLas(input.reader->header()));
    LasInfo info;
    info.warnings = input.reader->warnings();
    info.warnings.insert(info.warnings.end(), reading.warnings.begin(), reading.warnings.end());
    info.crs = reading.crs;
    info.input = std::move(input);
    return info;
}

void printAsJson(const std::string& path, const LasInfo& info) {
    const las::Header& header = info.header();
    cli::Json json = {{"file", path},
                      {"format", lasFormatText(header)},
                      {"bytes", info.input.source->sizeBytes()},
                      {"points", info.input.reader->pointCount()},
                      {"statedPoints", header.pointCount},
                      {"recordBytes", header.recordLength},
                      {"system", header.systemIdentifier},
                      {"software", header.generatingSoftware},
                      {"creationYear", header.creationYear},
                      {"creationDay", header.creationDay},
                      {"globalEncoding", header.globalEncoding}};
    json["grid"] = cli::gridJson(header.grid);
    json["bounds"] = cli::boxJson(header.bounds);
    json["crs"] = cli::crsJson(info.crs);
    json["attributes"] = cli::Json::array();
    for (const Attribute& attribute : info.input.reader->schema().attributes)
        json["attributes"].push_back(cli::attributeJson(attribute));
    json["records"] = cli::Json::array();
    for (const las::Vlr& vlr : header.vlrs)
        json["records"].push_back({{"user", vlr.userId},
                                   {"id", vlr.recordId},
                                   {"description", vlr.description},
                                   {"bytes", vlr.sizeBytes},
                                   {"extended", vlr.extended}});
    json["warnings"] = info.warnings;
    cli::printJson(json);
}

void printAsText(const std::string& path, const LasInfo& info) {
    const las::Header& header = info.header();
    fmt::print("{}: {}, {} points, {} bytes\n", path, lasFormatText(header), info.input.reader->pointCount(),
               info.input.source->sizeBytes());
    fmt::print("made by \"{}\" with \"{}\"\n", header.systemIdentifier, header.generatingSoftware);
    fmt::print("CRS: {}\n", cli::crsText(info.crs));
    for (int axis = 0; axis < 3; ++axis)
        fmt::print("{}: {} to {} (stated), scale {}, offset {}\n", "xyz"[axis], header.bounds.min[axis],
                   header.bounds.max[axis], header.grid.scale[axis], header.grid.offset[axis]);
    fmt::print("attributes:\n");
    for (const Attribute& attribute : info.input.reader->schema().attributes)
        fmt::print("  {:<32} {}{}\n", attribute.name, attributeTypeName(attribute.type),
                   attribute.components > 1 ? fmt::format(" x {}", attribute.components) : "");
    fmt::print("records:\n");
    for (const las::Vlr& vlr : header.vlrs)
        fmt::print("  {:<16} {:>5} {:>8} bytes{}  {}\n", vlr.userId, vlr.recordId, vlr.sizeBytes,
                   vlr.extended ? ", extended" : "", vlr.description);
    for (const std::string& warning : info.warnings)
        fmt::print("warning: {}\n", warning);
}
} // namespace

Status printLasInfo(const std::string& path, bool json) {
    STIPPLE_TRY(info, readLasInfo(path));
    if (json)
        printAsJson(path, info);
    else
        printAsText(path, info);
    return {};
}

} // namespace stipple
