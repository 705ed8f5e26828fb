#include "server/api/points_request.hpp"

#include "converter/export/filter_text.hpp"
#include "converter/export/polygon_crs.hpp"
#include "converter/export/region_text.hpp"
#include "server/api/points_parameters.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"
#include "shared/select/cloud_filter.hpp"
#include "shared/select/region_json.hpp"
#include "shared/select/region_options.hpp"

#include <nlohmann/json.hpp>

#include <limits>

namespace stipple::server {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// An error of what reads a value, made one of the parameter.
Error inParameter(const Parameter& parameter, const Error& error) {
    return parameterError(parameter.name, error.what, error.advice);
}

class RequestReader {
  public:
    explicit RequestReader(const ApiCall& call) : query_(call.query), metadata_(call.cloud->metadata) {}

    Result<PointsRequest> read() {
        STIPPLE_CHECK(readBox());
        STIPPLE_CHECK(readRotatedBox());
        STIPPLE_CHECK(readHeights());
        STIPPLE_CHECK(readPolygon());
        STIPPLE_CHECK(readLine());
        STIPPLE_CHECK(readRegion());
        STIPPLE_CHECK(readConditions());
        STIPPLE_CHECK(readAmount());
        STIPPLE_TRY(attributes, attributesOf(query_, metadata_.schema));
        request_.attributes = std::move(attributes);
        return std::move(request_);
    }

  private:
    Status readBox() {
        STIPPLE_TRY(numbers, numbersOf(query_, boxParameter));
        if (!numbers)
            return {};
        const std::vector<double>& n = *numbers;
        BoxD box = n.size() == 4 ? BoxD{{n[0], n[1], -infinity}, {n[2], n[3], infinity}}
                                 : BoxD{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}};
        for (int axis = 0; axis < 3; ++axis)
            if (box.min[axis] > box.max[axis])
                return parameterError(boxParameter.name,
                                      cat("it is empty: its ", "xyz"[axis], " goes from ", box.min[axis],
                                          " to ", box.max[axis]),
                                      "give the smaller corner first");
        request_.filter.box = box;
        return {};
    }

    Status readRotatedBox() {
        STIPPLE_TRY(center, numbersOf(query_, centerParameter));
        STIPPLE_TRY(size, numbersOf(query_, sizeParameter));
        STIPPLE_TRY(rotation, numbersOf(query_, rotationParameter));
        if (!center && !size && !rotation)
            return {};
        if (!center)
            return missingParameter(centerParameter);
        if (!size)
            return missingParameter(sizeParameter);
        STIPPLE_TRY(box, rotatedBox(*center, *size, rotation ? *rotation : std::vector<double>()));
        request_.filter.convex = box;
        return {};
    }

    Status readHeights() {
        STIPPLE_TRY(low, numberOf(query_, minZParameter));
        STIPPLE_TRY(high, numberOf(query_, maxZParameter));
        if (!low && !high)
            return {};
        ValueRange heights{low.value_or(-infinity), high.value_or(infinity)};
        if (heights.min > heights.max)
            return parameterError(maxZParameter.name, "it is below minz", "give the smaller height as minz");
        limitHeights(request_.filter, heights);
        const BoxD& box = *request_.filter.box;
        if (box.min.z > box.max.z)
            return parameterError(low ? minZParameter.name : maxZParameter.name,
                                  "no height of the box is left", "");
        return {};
    }

    Status readPolygon() {
        const std::string* text = query_.find(polygonParameter.name);
        if (!text)
            return {};
        const std::string name(polygonParameter.name);
        auto region = regionFromText(*text, name);
        if (!region) { // "polygon, line 1, column 5"
            const Error& error = region.error();
            std::string place =
                error.where.starts_with(name + ", ") ? error.where.substr(name.size() + 2) + ": " : "";
            return parameterError(name, place + error.what, error.advice);
        }
        std::vector<std::string> warnings; // nobody to tell
        if (Status same = checkPolygonCrs(metadata_.crs, region->crs, warnings); !same)
            return inParameter(polygonParameter, same.error());
        request_.filter.region = region->region;
        return {};
    }

    Status readLine() {
        const std::string* text = query_.find(lineParameter.name);
        if (!text)
            return {};
        auto line = lineFromText(*text);
        if (!line)
            return inParameter(lineParameter, line.error());
        STIPPLE_TRY(width, numberOf(query_, widthParameter));
        if (!width)
            return missingParameter(widthParameter);
        auto corridor = Corridor::make(*line, *width);
        if (!corridor)
            return inParameter(lineParameter, corridor.error());
        request_.filter.corridor = std::make_shared<const Corridor>(*std::move(corridor));
        return {};
    }

    // Together with what the other parameters say, but for a second one of a kind.
    Status readRegion() {
        const std::string* text = query_.find(regionParameter.name);
        if (!text)
            return {};
        if (!nlohmann::json::accept(*text))
            return parameterError(regionParameter.name, "it is no JSON", "percent-encode it");
        if (Status added = addRegion(request_.filter, *text); !added.ok()) {
            const Error& error = added.error();
            std::string place = error.where.empty() ? "" : error.where + ": ";
            return parameterError(regionParameter.name, place + error.what, error.advice);
        }
        return {};
    }

    Status readConditions() {
        std::vector<AttributeCondition>& conditions = request_.filter.conditions;
        if (const std::string* text = query_.find(classParameter.name)) {
            auto ranges = rangesFromText(*text);
            if (!ranges)
                return inParameter(classParameter, ranges.error());
            conditions.push_back({std::string(attribute_names::classification), *ranges});
            STIPPLE_CHECK(checkAttribute(classParameter, conditions.back().attribute));
        }
        if (const std::string* text = query_.find(whereParameter.name)) {
            auto more = conditionsFromText(*text);
            if (!more)
                return inParameter(whereParameter, more.error());
            for (AttributeCondition& condition : *more) {
                STIPPLE_CHECK(checkAttribute(whereParameter, condition.attribute));
                conditions.push_back(std::move(condition));
            }
        }
        return {};
    }

    Status checkAttribute(const Parameter& parameter, const std::string& name) {
        PointFilter one;
        one.conditions = {{name, {}}};
        auto filter = CloudFilter::make(metadata_, one);
        return filter ? Status() : Status(inParameter(parameter, filter.error()));
    }

    Status readAmount() {
        STIPPLE_TRY(spacing, numberOf(query_, spacingParameter));
        request_.filter.spacing = spacing.value_or(0);
        if (spacing && !(metadata_.spacing > 0))
            return parameterError(spacingParameter.name,
                                  "the cloud does not say how far apart its points are", "leave it out");
        STIPPLE_TRY(limit, countOf(query_, limitParameter));
        request_.limit = limit.value_or(0);
        return {};
    }

    const Query& query_;
    const CloudMetadata& metadata_;
    PointsRequest request_;
};

} // namespace

Result<PointsRequest> pointsRequestOf(const ApiCall& call) {
    return RequestReader(call).read();
}

std::string canonicalQuery(const Query& query, std::span<const Parameter> parameters) {
    std::string text;
    for (const Parameter& parameter : parameters)
        if (const std::string* value = query.find(parameter.name))
            text += cat(parameter.name, "=", value->size(), ":", *value, "\n");
    return text;
}

Error missingParameter(const Parameter& parameter) {
    return {ErrorCode::notFound, "it has to be given", std::string(parameter.name), ""};
}

HttpResponse requestProblem(const Error& error) {
    if (error.code == ErrorCode::notFound)
        return problemResponse({problem_types::missingParameter, error.sentence(), error.where});
    return parameterProblem(error);
}

} // namespace stipple::server
