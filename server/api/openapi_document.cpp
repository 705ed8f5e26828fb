#include "server/api/openapi_document.hpp"

#include "server/api/api.hpp"
#include "server/api/node_endpoint.hpp"
#include "server/api/openapi_schemas.hpp"
#include "server/http/problem.hpp"
#include "server/http/representation.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* prefix = "/api/v1";

// What any request may be answered with, whatever it asks for.
constexpr std::array statusesOfAll{400, 408, 413, 414, 417, 431, 500, 501, 503, 505};

const char* const about =
    "Clouds of points by address. Requests are GET (or HEAD, or OPTIONS) and have no body. Addresses are "
    "read "
    "strictly: unknown parameters, parameters given twice and values out of range are refused, never passed "
    "over. Answers have strong entity tags; with `version` in the address they may be kept for ever. Errors "
    "are RFC 9457 problem documents.";

// The {…} of paths.
Json pathParameters(std::string_view path) {
    Json names = Json::array();
    for (const ProblemType& type : problemTypes())
        names.push_back(type.name);
    Json parameters = Json::array();
    auto add = [&](const char* name, const char* description, Json schema) {
        if (path.find(cat("{", name, "}")) != std::string_view::npos)
            parameters.push_back({{"name", name},
                                  {"in", "path"},
                                  {"required", true},
                                  {"description", description},
                                  {"schema", std::move(schema)}});
    };
    add("id", "Id of a cloud, as /api/v1/clouds lists them.", {{"type", "string"}});
    add("key", "Key of a node: level-x-y-z; 0-0-0-0 is the root.",
        {{"$ref", "#/components/schemas/NodeKey"}});
    add("name", "Last segment of a problem's type.", {{"type", "string"}, {"enum", std::move(names)}});
    return parameters;
}

Json fieldJson(const char* description, bool isAlways) {
    return {{"description", description}, {"required", isAlways}, {"schema", {{"type", "string"}}}};
}

bool hasFormat(const Endpoint& endpoint, std::string_view name) {
    return std::any_of(endpoint.formats.begin(), endpoint.formats.end(),
                       [&](const Format& format) { return format.name == name; });
}

Json fieldsJson(const Endpoint& endpoint) {
    Json fields{{"ETag", fieldJson("Strong; of this answer.", true)},
                {"Cache-Control", fieldJson("Immutable if `version` is given, else no-cache.", true)}};
    if (endpoint.formats.size() > 1)
        fields["Vary"] = fieldJson("Accept, where it chose the format.", false);
    if (endpoint.path == "/clouds")
        fields["Link"] = fieldJson("The next page, where there is one (RFC 8288).", false);
    if (hasFormat(endpoint, lasFormat.name))
        fields["Content-Disposition"] = fieldJson("The name of the file, for formats of files.", false);
    if (hasFormat(endpoint, lasFormat.name) && endpoint.path != "/clouds/{id}/nodes/{key}")
        fields["Stipple-Point-Count"] = fieldJson("Points that follow, where that is known.", false);
    return fields;
}

Json contentJson(const Endpoint& endpoint) {
    Json content;
    for (const Format& format : endpoint.formats) {
        Json media = Json::object(); // of bytes there is nothing to say
        if (format.mediaType == jsonFormat.mediaType)
            media["schema"] = {{"$ref", cat("#/components/schemas/", endpoint.schema)}};
        content[std::string(format.mediaType)] = std::move(media);
    }
    return content;
}

// By which refusals the endpoint answers beside those of all.
std::set<int> statusesOf(const Endpoint& endpoint) {
    std::set<int> statuses(statusesOfAll.begin(), statusesOfAll.end());
    statuses.insert({304, 412});
    if (endpoint.isOfCloud())
        statuses.insert({401, 403, 404});
    else if (endpoint.path == "/clouds")
        statuses.insert(401);
    else if (endpoint.path.find('{') != std::string_view::npos)
        statuses.insert(404);
    for (const Parameter& parameter : endpoint.parameters)
        if (parameter.name == versionParameter.name)
            statuses.insert(410);
    if (endpoint.formats.size() > 1)
        statuses.insert(406);
    if (endpoint.isWork)
        statuses.insert(429);
    if (endpoint.hasRanges)
        statuses.insert(416);
    return statuses;
}

Json problemReference(int status) {
    return {{"$ref", cat("#/components/responses/", status == 304 ? "NotModified" : cat("Problem", status))}};
}

Json responsesJson(const Endpoint& endpoint) {
    Json responses;
    responses["200"] = {{"description", endpoint.summary},
                        {"headers", fieldsJson(endpoint)},
                        {"content", contentJson(endpoint)}};
    if (endpoint.hasRanges)
        responses["206"] = {{"description", "The ranges that the field Range names"},
                            {"content",
                             {{std::string(jsonFormat.mediaType), Json::object()},
                              {"multipart/byteranges", Json::object()}}}};
    for (int status : statusesOf(endpoint))
        responses[std::to_string(status)] = problemReference(status);
    return responses;
}

// Public clouds need none.
Json securityJson() {
    Json none = Json::object(), list = Json::array();
    return {none, {{"bearer", list}}, {{"expires", list}, {"signature", list}}};
}

Json operationJson(const Endpoint& endpoint, const char* method) {
    bool isHead = std::string_view(method) == "head";
    Json responses = responsesJson(endpoint);
    if (isHead) // the fields alone
        for (auto& [status, response] : responses.items())
            response.erase("content");
    if (isHead && responses.contains("206")) { // HEAD ignores Range
        responses.erase("206");
        responses.erase("416");
    }
    Json operation{
        {"operationId", isHead ? cat(endpoint.name, "Head") : std::string(endpoint.name)},
        {"summary", isHead ? cat("The fields of: ", endpoint.summary) : std::string(endpoint.summary)}};
    if (endpoint.isOfCloud() || endpoint.path == "/clouds")
        operation["security"] = securityJson();
    if (!endpoint.example.empty())
        operation["x-example"] = endpoint.example;
    operation["responses"] = std::move(responses);
    return operation;
}

Json pathJson(const Endpoint& endpoint) {
    Json path = Json::object();
    Json parameters = pathParameters(endpoint.path);
    for (const Parameter& parameter : endpoint.parameters)
        parameters.push_back(openApiParameter(parameter));
    if (!parameters.empty())
        path["parameters"] = std::move(parameters);
    for (const char* method : {"get", "head"})
        path[method] = operationJson(endpoint, method);
    return path;
}

Json schemasJson() {
    Json schemas = Json::parse(cloudSchemas);
    schemas.update(Json::parse(pointSchemas));
    Json types = Json::array();
    for (const ProblemType& type : problemTypes())
        types.push_back(problemAddress(type));
    schemas["Problem"]["properties"]["type"]["enum"] = std::move(types);
    return schemas;
}

Json credentialsJson() {
    auto ofAddress = [](const char* name, const char* description) {
        return Json{{"type", "apiKey"}, {"in", "query"}, {"name", name}, {"description", description}};
    };
    return {
        {"bearer",
         {{"type", "http"}, {"scheme", "bearer"}, {"description", "A token that `stipple access` made."}}},
        {"expires", ofAddress("expires", "Until when a signed address holds, seconds since 1970.")},
        {"signature", ofAddress("signature", "Of a signed address; see HTTP.md, \"Rights\".")}};
}

Json problemsJson() {
    Json responses{{"NotModified", openApiProblem(304)}};
    for (const ProblemType& type : problemTypes())
        responses[cat("Problem", type.status)] = openApiProblem(type.status);
    return responses;
}

} // namespace

Json openApiDocument(std::span<const Endpoint> endpoints) {
    Json paths = Json::object();
    for (const Endpoint& endpoint : endpoints)
        paths[cat(prefix, endpoint.path)] = pathJson(endpoint);
    paths.update(otherPathsJson());
    return {{"openapi", "3.1.0"},
            {"info", {{"title", "Stipple"}, {"version", STIPPLE_VERSION}, {"description", about}}},
            {"servers", {{{"url", "/"}}}},
            {"paths", std::move(paths)},
            {"components",
             {{"schemas", schemasJson()},
              {"responses", problemsJson()},
              {"securitySchemes", credentialsJson()}}}};
}

Answer answerOpenApi(const ApiCall& call) {
    static const std::string text = openApiDocument(endpoints()).dump(2) + "\n";
    return answerRepresentation(call.request, Representation::ofText(text, "application/json", "no-cache"),
                                call.nowSeconds);
}

} // namespace stipple::server
