#include "converter/verbs/info_input.hpp"

#include "converter/input/open.hpp"
#include "converter/verbs/metadata_json.hpp"

#include <fmt/format.h>

namespace stipple {

namespace {
BoxD worldBox(const InputDescription& d) {
    BoxD box;
    if (!d.bounds.empty()) {
        box.extend(d.grid.toWorld(d.bounds.min));
        box.extend(d.grid.toWorld(d.bounds.max));
    }
    return box;
}

const char* gpsTimeName(GpsTimeKind kind) {
    return kind == GpsTimeKind::week               ? "week"
           : kind == GpsTimeKind::adjustedStandard ? "adjusted standard"
                                                   : "unknown";
}

void printAsJson(const PointInput& input) {
    const InputDescription& d = input.description();
    cli::Json json = {{"file", d.path},
                      {"format", d.source.format},
                      {"bytes", d.source.sizeBytes},
                      {"points", d.source.pointCount},
                      {"parts", input.parts().size()}};
    json["grid"] = cli::gridJson(d.grid);
    json["bounds"] = cli::boxJson(worldBox(d));
    json["boundsAreMeasured"] = d.boundsAreMeasured;
    json["crs"] = cli::crsJson(d.crs);
    json["gpsTime"] = gpsTimeName(d.gpsTime);
    json["attributes"] = cli::Json::array();
    for (const Attribute& attribute : d.schema.attributes)
        json["attributes"].push_back(cli::attributeJson(attribute));
    json["warnings"] = d.warnings;
    cli::printJson(json);
}

void printAsText(const PointInput& input) {
    const InputDescription& d = input.description();
    fmt::print("{}: {}, {} points, {} bytes, read in {} part{}\n", d.path, d.source.format,
               d.source.pointCount, d.source.sizeBytes, input.parts().size(),
               input.parts().size() == 1 ? "" : "s");
    fmt::print("CRS: {}\n", cli::crsText(d.crs));
    BoxD box = worldBox(d);
    for (int axis = 0; axis < 3; ++axis) {
        std::string range = box.empty() ? "no bounds stated"
                                        : fmt::format("{} to {} ({})", box.min[axis], box.max[axis],
                                                      d.boundsAreMeasured ? "measured" : "stated");
        fmt::print("{}: {}, scale {}, offset {}\n", "xyz"[axis], range, d.grid.scale[axis],
                   d.grid.offset[axis]);
    }
    fmt::print("attributes:\n");
    for (const Attribute& attribute : d.schema.attributes)
        fmt::print("  {:<32} {}{}\n", attribute.name, attributeTypeName(attribute.type),
                   attribute.components > 1 ? fmt::format(" x {}", attribute.components) : "");
    for (const std::string& warning : d.warnings)
        fmt::print("warning: {}\n", warning);
}
} // namespace

Status printInputInfo(const std::string& path, bool json) {
    STIPPLE_TRY(input, openInput(path));
    if (json)
        printAsJson(*input);
    else
        printAsText(*input);
    return {};
}

} // namespace stipple
