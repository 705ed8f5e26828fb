#include "server/api/api.hpp"

#include "server/api/validity.hpp"
#include "server/http/problem.hpp"
#include "server/site/cloud_problem.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple::server {

namespace {

constexpr std::size_t prefixSegments = 2; // "api", "v1"

// The next segment of an endpoint's path, taken off its front: "{id}" of "/{id}/nodes".
std::string_view takeSegment(std::string_view& path) {
    path.remove_prefix(1);
    std::string_view segment = path.substr(0, path.find('/'));
    path.remove_prefix(segment.size());
    return segment;
}

// True if the endpoint's path is that of the target; then `names` has what stands for its {…}.
bool matches(std::string_view path, std::span<const std::string> segments, std::vector<std::string>& names) {
    names.clear();
    for (const std::string& segment : segments) {
        if (path.empty())
            return false;
        std::string_view expected = takeSegment(path);
        if (expected.starts_with('{') && !segment.empty())
            names.push_back(segment);
        else if (expected != segment)
            return false;
    }
    return path.empty();
}

Status checkNames(const Query& query, std::span<const Parameter> parameters) {
    std::vector<std::string_view> names;
    for (const Parameter& parameter : parameters)
        names.push_back(parameter.name);
    return query.allowOnly(names);
}

HttpResponse unknownParameterProblem(const Error& error) {
    return problemResponse({problem_types::unknownParameter, error.sentence(), error.where});
}

} // namespace

bool isApiPath(const Target& target) {
    const auto& path = target.segments;
    return path.size() > prefixSegments && path[0] == "api" && path[1] == "v1";
}

Answer answerApi(const HttpRequest& request, const Target& target, const ApiContext& context,
                 std::int64_t nowSeconds) {
    std::vector<std::string> names;
    auto segments = std::span(target.segments).subspan(prefixSegments);
    auto endpoint = std::find_if(endpoints().begin(), endpoints().end(), [&](const Endpoint& candidate) {
        return matches(candidate.path, segments, names);
    });
    if (endpoint == endpoints().end())
        return problemResponse(404, "there is nothing at this address");
    auto query = Query::parse(target.query);
    if (!query)
        return parameterProblem(query.error());
    if (Status known = checkNames(*query, endpoint->parameters); !known)
        return unknownParameterProblem(known.error());

    ApiCall call{request,         *query,          std::move(names), "", nullptr, nowSeconds,
                 context.visitor, context.catalog, context.resources};
    if (endpoint->isOfCloud()) {
        call.id = call.names.front();
        auto cloud = context.catalog.current(call.id);
        if (!cloud)
            return cloudProblem(cloud.error());
        call.cloud = *cloud;
        if (auto gone = goneVersion(call))
            return *gone;
    }
    return endpoint->answer(call);
}

} // namespace stipple::server
