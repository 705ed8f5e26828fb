#include "server/api/nearest_endpoint.hpp"

#include "converter/export/json_sink.hpp"
#include "converter/export/nearest_points.hpp"
#include "server/api/points_parameters.hpp"
#include "server/api/points_request.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"
#include "shared/geometry/exact_sum.hpp"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

struct NearestRequest {
    PointsRequest points;
    std::shared_ptr<const PointRank> rank;
    const RayRank* ray = nullptr; // the rank, where it is one
    std::size_t count = 1;
};

// Numbers that are no place are refused before anything is computed with them.
Result<std::optional<Vec3d>> vectorOf(const Query& query, const Parameter& parameter) {
    STIPPLE_TRY(numbers, numbersOf(query, parameter));
    if (!numbers)
        return std::optional<Vec3d>();
    for (double number : *numbers)
        if (!isExactlySummable(number))
            return parameterError(parameter.name, "a number is out of range",
                                  "give numbers of 1e-100 to 1e100, or 0");
    return std::optional(Vec3d{(*numbers)[0], (*numbers)[1], numbers->size() == 3 ? (*numbers)[2] : 0});
}

Status refuseOthers(const Query& query, std::initializer_list<Parameter> others, std::string_view given) {
    for (const Parameter& other : others)
        if (query.has(other.name))
            return parameterError(other.name, cat("it has no meaning with ", given), "leave one of them out");
    return {};
}

Status readPlace(const Query& query, Vec3d place, double most, NearestRequest& request) {
    STIPPLE_CHECK(refuseOthers(query, {originParameter, directionParameter, radiusParameter, angleParameter},
                               pointParameter.name));
    STIPPLE_TRY(numbers, numbersOf(query, pointParameter));
    request.rank = std::make_shared<DistanceRank>(place, numbers->size() == 2, most);
    return {};
}

Status readRay(const Query& query, double most, NearestRequest& request) {
    STIPPLE_TRY(origin, vectorOf(query, originParameter));
    STIPPLE_TRY(direction, vectorOf(query, directionParameter));
    if (!origin)
        return missingParameter(direction ? originParameter : pointParameter);
    if (!direction)
        return missingParameter(directionParameter);
    if (!(length(*direction) > 0) || !std::isfinite(length(*direction)))
        return parameterError(directionParameter.name, "it has no direction",
                              "give a vector that is not 0,0,0");
    STIPPLE_TRY(radius, numberOf(query, radiusParameter));
    STIPPLE_TRY(angle, numberOf(query, angleParameter));
    if (!radius && !angle)
        return missingParameter(radiusParameter);
    if (radius)
        STIPPLE_CHECK(refuseOthers(query, {angleParameter}, radiusParameter.name));
    double slope = std::tan(angle.value_or(0) * std::numbers::pi / 180);
    auto ray = std::make_shared<RayRank>(*origin, *direction, radius.value_or(0), slope, most);
    request.ray = ray.get();
    request.rank = ray;
    return {};
}

Result<NearestRequest> nearestRequestOf(const ApiCall& call) {
    NearestRequest request;
    STIPPLE_TRY(points, pointsRequestOf(call));
    request.points = std::move(points);
    STIPPLE_TRY(count, countOf(call.query, countParameter));
    request.count = static_cast<std::size_t>(count.value_or(1));
    STIPPLE_TRY(most, numberOf(call.query, maxDistanceParameter));
    double furthest = most.value_or(std::numeric_limits<double>::infinity());
    STIPPLE_TRY(place, vectorOf(call.query, pointParameter));
    STIPPLE_CHECK(place ? readPlace(call.query, *place, furthest, request)
                        : readRay(call.query, furthest, request));
    return request;
}

// The attributes of the points, and their world coordinates, as the rows that JSON exports have.
Result<Json> rowsOf(CloudReader& reader, const std::vector<RankedPoint>& points,
                    const std::vector<int>& attributes, const WorkGate& gate) {
    SinkInput input{reader.metadata(), attributes};
    PointBatch batch;
    batch.resize(input.schema(), points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
        batch.positions[i] = points[i].position;
        bool isKnown = false;
        for (std::size_t k = 0; k < i; ++k)
            isKnown = isKnown || points[k].node.key == points[i].node.key;
        if (isKnown) // copied with the first of its node
            continue;
        STIPPLE_TRY(bytes, reader.fetchNode(points[i].node, attributes));
        STIPPLE_TRY(node, decodeNode(reader.metadata(), bytes, &gate));
        for (std::size_t k = i; k < points.size(); ++k) {
            if (points[k].node.key != points[i].node.key)
                continue;
            for (std::size_t a = 0; a < attributes.size(); ++a) {
                std::size_t size = input.attribute(a).size();
                std::memcpy(batch.columns[a].data() + k * size,
                            node.columns[a].data() + points[k].index * size, size);
            }
        }
    }
    Bytes text;
    STIPPLE_TRY(sink, jsonSink(std::make_unique<MemorySink>(text), input));
    STIPPLE_TRY(encoded, sink->encode(std::move(batch)));
    STIPPLE_CHECK(sink->write(std::move(encoded)));
    STIPPLE_CHECK(sink->finish());
    return Json::parse(text.begin(), text.end());
}

Json attributesJson(const Schema& schema, const std::vector<int>& attributes, const Json& row) {
    Json values = Json::object();
    std::size_t column = 3; // behind X, Y, Z
    for (int index : attributes) {
        const Attribute& attribute = schema.attributes[static_cast<std::size_t>(index)];
        if (attribute.components == 1) {
            values[attribute.name] = row[column++];
            continue;
        }
        Json& list = values[attribute.name] = Json::array();
        for (int c = 0; c < attribute.components; ++c)
            list.push_back(row[column++]);
    }
    return values;
}

class NearestAnswer {
  public:
    NearestAnswer(const ApiCall& call, NearestRequest request, CloudFilter filter, HttpResponse head)
        : id_(call.id), cloud_(call.cloud), request_(std::move(request)), filter_(std::move(filter)),
          head_(std::move(head)) {}

    Status answer(AnswerWriter& writer) const {
        auto source = cloud_->openSource();
        auto reader = CloudReader::over(*source, cloud_->header, cloud_->metadata);
        StopGate gate(&writer.isStopped());
        STIPPLE_TRY(found,
                    nearestPoints(*reader, "the cloud", filter_, *request_.rank, request_.count, &gate));
        STIPPLE_TRY(document, documentOf(*reader, found, gate));
        HttpResponse response = head_;
        response.body.emplace_back(document.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n");
        writer.answer(std::move(response));
        return {};
    }

  private:
    Result<Json> documentOf(CloudReader& reader, const NearestPoints& found, const WorkGate& gate) const {
        const CloudMetadata& metadata = reader.metadata();
        STIPPLE_TRY(rows, rowsOf(reader, found.points, request_.points.attributes, gate));
        Json points = Json::array();
        for (std::size_t i = 0; i < found.points.size(); ++i) {
            const RankedPoint& point = found.points[i];
            const Json& row = rows["points"][i];
            Json json{{"node", point.node.key.text()},
                      {"index", point.index},
                      {"grid", {point.position.x, point.position.y, point.position.z}},
                      {"position", {row[0], row[1], row[2]}}};
            if (request_.ray) {
                json["distance"] = request_.ray->distanceFromRay(metadata.grid.toWorld(point.position));
                json["along"] = point.rank;
            } else {
                json["distance"] = point.rank;
            }
            json["attributes"] = attributesJson(metadata.schema, request_.points.attributes, row);
            points.push_back(std::move(json));
        }
        const NearestCounters& counters = found.counters;
        return Json{{"id", id_},
                    {"version", cloud_->version()},
                    {"points", std::move(points)},
                    {"read",
                     {{"nodes", counters.nodesRead},
                      {"bytes", counters.bytesRead},
                      {"points", counters.pointsRanked},
                      {"hierarchyChunks", counters.chunksRead}}}};
    }

    std::string id_;
    std::shared_ptr<const CloudVersion> cloud_;
    NearestRequest request_;
    CloudFilter filter_; // over cloud_->metadata
    HttpResponse head_;
};

} // namespace

Answer answerNearest(const ApiCall& call) {
    if (auto gone = goneVersion(call))
        return *std::move(gone);
    auto request = nearestRequestOf(call);
    if (!request)
        return requestProblem(request.error());
    auto filter = CloudFilter::make(call.cloud->metadata, request->points.filter);
    if (!filter)
        return parameterProblem(parameterError("", filter.error().what, filter.error().advice));
    Validity validity = validityOf(call, cat("nearest\n", canonicalQuery(call.query, nearestParameters)));
    if (validity.conditional)
        return *std::move(validity.conditional);
    HttpResponse head;
    head.set("Content-Type", "application/json");
    validity.setFields(head);
    auto answer =
        std::make_shared<const NearestAnswer>(call, *std::move(request), *std::move(filter), std::move(head));
    return Job{"nearest", [answer](AnswerWriter& writer) { return answer->answer(writer); }};
}

} // namespace stipple::server
