#include "server/api/openapi_document.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

Json problems(std::initializer_list<int> statuses) {
    Json responses;
    for (int status : statuses)
        responses[std::to_string(status)] = {{"$ref", cat("#/components/responses/Problem", status)}};
    return responses;
}

Json bytes(const char* description, std::initializer_list<const char*> mediaTypes) {
    Json content;
    for (const char* type : mediaTypes)
        content[type] = Json::object();
    return {{"description", description}, {"content", std::move(content)}};
}

Json filePath() {
    constexpr const char* octets = "application/octet-stream";
    Json responses = problems({400, 401, 403, 404, 408, 412, 413, 414, 416, 417, 431, 500, 501, 503, 505});
    responses["200"] = bytes("The whole file", {octets});
    responses["206"] = bytes("The ranges that the field Range names", {octets, "multipart/byteranges"});
    responses["304"] = {{"$ref", "#/components/responses/NotModified"}};
    Json none = Json::object(), list = Json::array();
    Json range{{"name", "Range"},
               {"in", "header"},
               {"description", "Ranges of bytes (RFC 9110, 14.2), at most 64."},
               {"schema", {{"type", "string"}}},
               {"example", "bytes=0-65535"}};
    Json id{{"name", "id"}, {"in", "path"}, {"required", true}, {"schema", {{"type", "string"}}}};
    return {{"get",
             {{"operationId", "getFile"},
              {"summary", "The file of a cloud, or ranges of it"},
              {"parameters", {id, range}},
              {"security", {none, {{"bearer", list}}, {{"expires", list}, {"signature", list}}}},
              {"responses", std::move(responses)}}}};
}

Json healthPath(const char* name, const char* summary) {
    Json responses = problems({400, 408, 413, 417, 431, 501, 503, 505});
    Json schema{{"type", "object"},
                {"required", {"status"}},
                {"properties", {{"status", {{"const", "ok"}}}}},
                {"additionalProperties", false}};
    responses["200"] = {{"description", summary}, {"content", {{"application/json", {{"schema", schema}}}}}};
    return {{"get", {{"operationId", name}, {"summary", summary}, {"responses", std::move(responses)}}}};
}

Json metricsPath() {
    Json responses = problems({400, 404, 408, 413, 417, 431, 501, 503, 505});
    responses["200"] = bytes("Prometheus' text format", {"text/plain"});
    return {{"get",
             {{"operationId", "getMetrics"},
              {"summary", "What the server counts, for those it lets in; 404 for others"},
              {"responses", std::move(responses)}}}};
}

} // namespace

Json otherPathsJson() {
    return {{"/clouds/{id}.stipple", filePath()},
            {"/healthz", healthPath("getHealth", "The server runs; 503 once its end is announced")},
            {"/readyz", healthPath("getReadiness", "The server takes more work; else 503")},
            {"/metrics", metricsPath()}};
}

} // namespace stipple::server
