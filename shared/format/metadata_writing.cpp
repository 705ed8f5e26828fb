#include "shared/format/block_frame.hpp"
#include "shared/format/file_parts.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace stipple {

namespace {

using Json = nlohmann::ordered_json; // people read it: keys stay in the order they are written

// JSON has no numbers for these.
Json numberJson(double value) {
    if (std::isnan(value))
        return "NaN";
    if (std::isinf(value))
        return value > 0 ? "Infinity" : "-Infinity";
    return value;
}

template <class T>
Json vecJson(const Vec3<T>& v) {
    return Json::array({Json(v.x), Json(v.y), Json(v.z)});
}

Json attributeJson(const Attribute& attribute, const AttributeStatistics& statistics) {
    Json json;
    json["name"] = attribute.name;
    json["type"] = attributeTypeName(attribute.type);
    json["components"] = attribute.components;
    json["description"] = attribute.description;
    json["unit"] = attribute.unit;
    json["scale"] = numberJson(attribute.scale);
    json["offset"] = numberJson(attribute.offset);
    if (attribute.noData)
        json["noData"] = numberJson(*attribute.noData);
    json["min"] = numberJson(statistics.min);
    json["max"] = numberJson(statistics.max);
    json["mean"] = numberJson(statistics.mean);
    json["deviation"] = numberJson(statistics.deviation);
    Json histogram = Json::array();
    for (const auto& [value, count] : statistics.histogram)
        histogram.push_back({value, count});
    json["histogram"] = std::move(histogram);
    return json;
}

// Text from elsewhere may be in any encoding; JSON is UTF-8. Bytes that are not become U+FFFD.
std::string dump(const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

} // namespace

Bytes writeMetadata(const CloudMetadata& metadata) {
    Json json;
    json["name"] = metadata.name;
    json["pointCount"] = metadata.pointCount;
    Json& crs = json["crs"];
    crs["name"] = metadata.crs.name;
    if (metadata.crs.epsg)
        crs["epsg"] = *metadata.crs.epsg;
    crs["unit"] = metadata.crs.unit;
    crs["unitMeters"] = numberJson(metadata.crs.unitMeters);
    crs["proj"] = metadata.crs.proj;
    crs["wkt"] = metadata.crs.wkt;
    if (!metadata.crs.vertical.empty())
        crs["vertical"] = metadata.crs.vertical;
    for (const CrsAxis& axis : metadata.crs.axes)
        crs["axes"].push_back({{"name", axis.name},
                               {"direction", axis.direction},
                               {"unit", axis.unit},
                               {"unitMeters", numberJson(axis.unitMeters)}});
    json["grid"] = {{"scale", vecJson(metadata.grid.scale)}, {"offset", vecJson(metadata.grid.offset)}};
    json["rootCube"] = {{"min", vecJson(metadata.rootCube.min)}, {"bits", metadata.rootCube.bits}};
    json["spacing"] = numberJson(metadata.spacing);
    if (metadata.sampling != Sampling::poisson)
        json["sampling"] = samplingNames[static_cast<std::size_t>(metadata.sampling)];
    if (!metadata.bounds.empty())
        json["bounds"] = {{"min", vecJson(metadata.bounds.min)}, {"max", vecJson(metadata.bounds.max)}};
    json["pictureColour"] = pictureColourNames[static_cast<std::size_t>(metadata.pictureColour)];
    if (metadata.innerColour != InnerColour::exact)
        json["innerColour"] = innerColourNames[static_cast<std::size_t>(metadata.innerColour)];
    json["colourIs8Bit"] = metadata.colourIs8Bit;
    json["attributes"] = Json::array();
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a)
        json["attributes"].push_back(
            attributeJson(metadata.schema.attributes[a],
                          a < metadata.statistics.size() ? metadata.statistics[a] : AttributeStatistics{}));
    json["pointHash"] = metadata.pointHash;
    json["sources"] = Json::array();
    for (const SourceFile& source : metadata.sources) {
        Json& entry = json["sources"].emplace_back(Json{{"name", source.name},
                                                        {"format", source.format},
                                                        {"pointCount", source.pointCount},
                                                        {"sizeBytes", source.sizeBytes}});
        if (!source.pointHash.empty())
            entry["pointHash"] = source.pointHash;
    }
    json["tool"] = metadata.tool;
    json["options"] = metadata.options;
    std::string text = dump(json);
    return frameBlock(ByteSpan(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()));
}

} // namespace stipple
