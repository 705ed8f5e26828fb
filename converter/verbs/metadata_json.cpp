#include "converter/verbs/metadata_json.hpp"

#include "shared/base/text.hpp"

#include <cstdio>

namespace stipple::cli {

namespace {
Json statisticsJson(const AttributeStatistics& statistics) {
    Json json = {{"min", statistics.min},
                 {"max", statistics.max},
                 {"mean", statistics.mean},
                 {"deviation", statistics.deviation}};
    for (const auto& [value, points] : statistics.histogram)
        json["histogram"].push_back(Json::array({value, points}));
    return json;
}

} // namespace

const char* colourName(PictureColour colour) {
    return colour == PictureColour::rgb ? "rgb" : colour == PictureColour::intensity ? "intensity" : "none";
}

Json vectorJson(const Vec3d& v) {
    return Json::array({v.x, v.y, v.z});
}

Json boxJson(const BoxD& box) {
    if (box.empty())
        return nullptr;
    return {{"min", vectorJson(box.min)}, {"max", vectorJson(box.max)}};
}

Json gridJson(const Grid& grid) {
    return {{"scale", vectorJson(grid.scale)}, {"offset", vectorJson(grid.offset)}};
}

Json crsJson(const Crs& crs) {
    if (!crs.known())
        return nullptr;
    Json json = {{"name", crs.name}};
    json["epsg"] = crs.epsg ? Json(*crs.epsg) : Json(nullptr);
    json["proj"] = crs.proj;
    json["unit"] = crs.unit;
    json["unitMeters"] = crs.unitMeters;
    if (!crs.vertical.empty())
        json["vertical"] = crs.vertical;
    for (const CrsAxis& axis : crs.axes)
        json["axes"].push_back({{"name", axis.name},
                                {"direction", axis.direction},
                                {"unit", axis.unit},
                                {"unitMeters", axis.unitMeters}});
    json["wkt"] = crs.wkt;
    return json;
}

Json attributeJson(const Attribute& attribute) {
    Json json = {{"name", attribute.name},
                 {"type", attributeTypeName(attribute.type)},
                 {"components", attribute.components}};
    if (!attribute.description.empty())
        json["description"] = attribute.description;
    if (!attribute.unit.empty())
        json["unit"] = attribute.unit;
    if (attribute.scale != 1 || attribute.offset != 0) {
        json["scale"] = attribute.scale;
        json["offset"] = attribute.offset;
    }
    if (attribute.noData)
        json["noData"] = *attribute.noData;
    return json;
}

Json metadataJson(const CloudMetadata& metadata) {
    Json json = {{"name", metadata.name}, {"points", metadata.pointCount}};
    json["crs"] = crsJson(metadata.crs);
    json["grid"] = gridJson(metadata.grid);
    json["bounds"] = boxJson(metadata.worldBounds());
    const Vec3i& corner = metadata.rootCube.min;
    json["rootCube"] = {{"min", Json::array({corner.x, corner.y, corner.z})},
                        {"bits", metadata.rootCube.bits}};
    json["spacing"] = metadata.spacing;
    json["sampling"] = samplingNames[static_cast<std::size_t>(metadata.sampling)];
    json["pictureColour"] = colourName(metadata.pictureColour);
    json["innerColour"] = innerColourNames[static_cast<std::size_t>(metadata.innerColour)];
    json["colourIs8Bit"] = metadata.colourIs8Bit;
    json["attributes"] = Json::array();
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a) {
        Json attribute = attributeJson(metadata.schema.attributes[a]);
        if (a < metadata.statistics.size())
            attribute.update(statisticsJson(metadata.statistics[a]));
        json["attributes"].push_back(std::move(attribute));
    }
    json["pointHash"] = metadata.pointHash;
    json["sources"] = Json::array();
    for (const SourceFile& source : metadata.sources)
        json["sources"].push_back({{"name", source.name},
                                   {"format", source.format},
                                   {"points", source.pointCount},
                                   {"bytes", source.sizeBytes},
                                   {"pointHash", source.pointHash}});
    json["tool"] = metadata.tool;
    json["options"] = metadata.options;
    return json;
}

void printJson(const Json& json) {
    std::printf("%s\n", json.dump(2, ' ', false, Json::error_handler_t::replace).c_str());
}

std::string crsText(const Crs& crs) {
    if (!crs.known())
        return "none known";
    std::string name = crs.name.empty() ? "unnamed" : crs.name;
    return crs.epsg ? cat(name, " (EPSG:", *crs.epsg, ")") : name;
}

} // namespace stipple::cli
