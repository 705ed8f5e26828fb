#include "client/core/cloud_facts.hpp"

#include "client/core/node_columns.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace stipple {

using nlohmann::json;

namespace {

json crsJson(const Crs& crs) {
    return {{"name", crs.name},         {"epsg", crs.epsg ? json(*crs.epsg) : json(nullptr)},
            {"wkt", crs.wkt},           {"proj", crs.proj},
            {"unit", crs.unit},         {"unitMeters", crs.unitMeters},
            {"vertical", crs.vertical}, {"geocentric", isGeocentric(crs)}};
}

json attributeJson(const Attribute& attribute, const AttributeStatistics* statistics) {
    json value = {{"name", attribute.name},
                  {"type", attributeTypeName(attribute.type)},
                  {"components", attribute.components},
                  {"unit", attribute.unit},
                  {"description", attribute.description},
                  {"isWhole", isWhole(attribute)}};
    auto set = [&](const char* name, double number) {
        value[name] = statistics && std::isfinite(number) ? json(number) : json(nullptr);
    };
    AttributeStatistics known = statistics ? *statistics : AttributeStatistics();
    double a = attribute.offset + attribute.scale * known.min,
           b = attribute.offset + attribute.scale * known.max;
    set("min", std::min(a, b));
    set("max", std::max(a, b));
    set("mean", attribute.offset + attribute.scale * known.mean);
    set("deviation", std::abs(attribute.scale) * known.deviation);
    return value;
}

} // namespace

bool isGeocentric(const Crs& crs) {
    return !crs.axes.empty() && crs.axes[0].direction.rfind("geocentric", 0) == 0;
}

json cloudFactsJson(const CloudMetadata& metadata) {
    json attributes = json::array();
    for (std::size_t a = 0; a < metadata.schema.attributes.size(); ++a) {
        bool hasStatistics = a < metadata.statistics.size() && metadata.pointCount > 0;
        attributes.push_back(
            attributeJson(metadata.schema.attributes[a], hasStatistics ? &metadata.statistics[a] : nullptr));
    }
    return {{"crs", crsJson(metadata.crs)}, {"attributes", std::move(attributes)}};
}

} // namespace stipple
