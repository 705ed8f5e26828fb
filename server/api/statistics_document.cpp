#include "server/api/statistics_document.hpp"

#include "shared/points/point_classes.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;
using Values = std::map<std::int64_t, std::uint64_t>;

// Infinity is no JSON.
Json numberJson(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

bool isWhole(AttributeType type) {
    return type != AttributeType::f32 && type != AttributeType::f64;
}

Json valuesJson(const StatisticsColumn& column, const Values& values) {
    Json list = Json::array();
    for (const auto& [value, points] : values)
        list.push_back({{"value", column.meaningOf(static_cast<double>(value))}, {"points", points}});
    return list;
}

void addNumbers(Json& json, const StatisticsColumn& column, const ColumnStatistics& statistics,
                bool isComputed) {
    const PartialStatistics& stored = statistics.stored;
    bool isCountKnown = isComputed || isWhole(column.attribute.type);
    if (isCountKnown)
        json["count"] = stored.count;
    if (stored.count > 0) {
        double first = column.meaningOf(stored.min), last = column.meaningOf(stored.max);
        json["min"] = numberJson(std::min(first, last));
        json["max"] = numberJson(std::max(first, last));
    }
}

void addMoments(Json& json, const StatisticsColumn& column, const PartialStatistics& stored) {
    if (stored.count == 0)
        return;
    json["mean"] = numberJson(column.meaningOf(stored.mean));
    json["deviation"] = numberJson(std::abs(column.attribute.scale) * stored.finish().deviation);
}

void addIntervals(Json& json, const StatisticsColumn& column, const ColumnStatistics& statistics) {
    if (!column.edges.empty())
        json["histogram"] = {{"edges", column.edges}, {"counts", statistics.counts}};
}

Json coordinateJson(const StatisticsAnswer& answer, std::size_t axis) {
    const StatisticsColumn& column = answer.columns[axis];
    Json json{{"name", column.attribute.name}};
    addNumbers(json, column, answer.statistics[axis], answer.isComputed);
    if (answer.isComputed)
        addMoments(json, column, answer.statistics[axis].stored);
    addIntervals(json, column, answer.statistics[axis]);
    return json;
}

Json attributeJson(const StatisticsAnswer& answer, std::size_t c) {
    const StatisticsColumn& column = answer.columns[c];
    const ColumnStatistics& statistics = answer.statistics[c];
    Json json{{"name", column.attribute.name},
              {"type", attributeTypeName(column.attribute.type)},
              {"components", column.attribute.components},
              {"unit", column.attribute.unit}};
    addNumbers(json, column, statistics, answer.isComputed);
    addMoments(json, column, statistics.stored);
    if (statistics.stored.histogram)
        json["values"] = valuesJson(column, *statistics.stored.histogram);
    addIntervals(json, column, statistics);
    return json;
}

// Values of an attribute and their points; null if the answer does not have them.
const Values* valuesOf(const StatisticsAnswer& answer, std::string_view name) {
    for (std::size_t c = 3; c < answer.columns.size(); ++c)
        if (answer.columns[c].attribute.name == name && answer.statistics[c].stored.histogram)
            return &*answer.statistics[c].stored.histogram;
    return nullptr;
}

Json countsJson(const Values& values, const char* name) {
    Json list = Json::array();
    for (const auto& [value, points] : values)
        list.push_back({{name, value}, {"points", points}});
    return list;
}

void addClasses(Json& json, const StatisticsAnswer& answer, const Schema& schema) {
    const Values* classes = valuesOf(answer, attribute_names::classification);
    if (!classes)
        return;
    json["classes"] = Json::array();
    for (const auto& [value, points] : *classes)
        json["classes"].push_back(
            {{"class", value}, {"name", className(schema, static_cast<int>(value))}, {"points", points}});
}

void addReturns(Json& json, const StatisticsAnswer& answer) {
    if (const Values* numbers = valuesOf(answer, attribute_names::returnNumber))
        json["returns"]["numbers"] = countsJson(*numbers, "return");
    if (const Values* pulses = valuesOf(answer, attribute_names::numberOfReturns))
        json["returns"]["pulses"] = countsJson(*pulses, "returns");
}

BoxD boundsOf(const StatisticsAnswer& answer) {
    BoxD box;
    if (answer.pointCount == 0)
        return box;
    Vec3d low, high;
    for (int axis = 0; axis < 3; ++axis) {
        const auto place = static_cast<std::size_t>(axis);
        low[axis] = answer.columns[place].meaningOf(answer.statistics[place].stored.min);
        high[axis] = answer.columns[place].meaningOf(answer.statistics[place].stored.max);
    }
    box.extend(low);
    box.extend(high);
    return box;
}

Json boundsJson(const BoxD& box) {
    if (box.empty())
        return nullptr;
    return {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
}

Json densityJson(const BoxD& box, std::uint64_t points, double unitMeters) {
    double area = box.empty() ? 0 : (box.max.x - box.min.x) * (box.max.y - box.min.y);
    if (!(area > 0) || !std::isfinite(area))
        return nullptr;
    Json json{{"area", area}, {"pointsPerArea", static_cast<double>(points) / area}};
    if (unitMeters > 0)
        json["pointsPerSquareMeter"] = static_cast<double>(points) / area / (unitMeters * unitMeters);
    return json;
}

Json levelsJson(const StatisticsAnswer& answer, double spacing) {
    Json levels = Json::array();
    for (std::size_t level = 0; level < answer.levels.size(); ++level)
        if (answer.levels[level].nodes > 0)
            levels.push_back({{"level", level},
                              {"spacing", numberJson(std::ldexp(spacing, -static_cast<int>(level)))},
                              {"nodes", answer.levels[level].nodes},
                              {"points", answer.levels[level].points}});
    return levels;
}

} // namespace

Json statisticsJson(const StatisticsAnswer& answer, const CloudMetadata& metadata) {
    BoxD bounds = boundsOf(answer);
    Json json{{"id", answer.id},
              {"version", answer.version},
              {"isComputed", answer.isComputed},
              {"pointCount", answer.pointCount},
              {"bounds", boundsJson(bounds)},
              {"density", densityJson(bounds, answer.pointCount, metadata.crs.unitMeters)},
              {"levels", levelsJson(answer, metadata.spacing)},
              {"coordinates", Json::array()},
              {"attributes", Json::array()}};
    for (std::size_t c = 0; c < answer.columns.size(); ++c)
        c < 3 ? json["coordinates"].push_back(coordinateJson(answer, c))
              : json["attributes"].push_back(attributeJson(answer, c));
    addClasses(json, answer, metadata.schema);
    addReturns(json, answer);
    return json;
}

} // namespace stipple::server
