#include "server/api/points_endpoint.hpp"

#include "server/api/point_file_job.hpp"
#include "server/api/points_parameters.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"
#include "shared/select/corridor_attributes.hpp"

#include <memory>

namespace stipple::server {

namespace {

Result<PointFile> pointFileOf(const ApiCall& call, const Format& format) {
    STIPPLE_TRY(request, pointsRequestOf(call));
    const PointLimits& limits = call.resources.limits.points;
    if (request.limit > limits.maxPoints)
        return parameterError(limitParameter.name, "it is more than the server gives to one request",
                              cat("at most ", limits.maxPoints));
    auto filter = CloudFilter::make(call.cloud->metadata, request.filter);
    if (!filter)
        return parameterError("", filter.error().what, filter.error().advice);
    PointFile file{call.cloud,
                   *std::move(filter),
                   std::move(request),
                   call.cloud->metadata,
                   {},
                   *exportFormatOf(format),
                   {},
                   limits,
                   call.resources.scratch};
    file.attributes = file.request.attributes;
    if (file.filter.hasCorridor()) {
        auto stored = static_cast<int>(file.metadata.schema.attributes.size());
        addCorridorAttributes(file.metadata);
        file.attributes.push_back(stored);
        file.attributes.push_back(stored + 1);
    }
    return file;
}

Answer answerPointFile(const ApiCall& call, const char* kind, std::span<const Parameter> parameters) {
    if (auto gone = goneVersion(call))
        return *std::move(gone);
    const std::string* formatName = call.query.find(pointFormatParameter.name);
    auto chosen = chooseFormat(call.request, formatName ? *formatName : "", pointFileFormats);
    if (auto* refusal = std::get_if<HttpResponse>(&chosen))
        return *refusal;
    auto [format, variesByAccept] = std::get<ChosenFormat>(chosen);
    auto file = pointFileOf(call, *format);
    if (!file)
        return requestProblem(file.error());

    std::string variant = cat(kind, " ", format->name, "\n", canonicalQuery(call.query, parameters));
    Validity validity = validityOf(call, variant, variesByAccept);
    if (validity.conditional)
        return *std::move(validity.conditional);
    validity.setFields(file->head);
    file->head.set("Content-Type", contentTypeOf(*format));
    file->head.set("Content-Disposition", contentDisposition(cat(call.id, "-", kind), *format));
    auto owned = std::make_shared<const PointFile>(*std::move(file));
    return Job{kind, [owned](AnswerWriter& writer) { return writePointFile(*owned, writer); }};
}

} // namespace

Answer answerPoints(const ApiCall& call) {
    return answerPointFile(call, "points", pointsParameters);
}

Answer answerProfile(const ApiCall& call) {
    for (const Parameter& parameter : {lineParameter, widthParameter})
        if (!call.query.has(parameter.name))
            return requestProblem(missingParameter(parameter));
    return answerPointFile(call, "profile", profileParameters);
}

} // namespace stipple::server
