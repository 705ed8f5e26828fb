#include "server/api/openapi_document.hpp"
#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

Json fieldJson(const char* description) {
    return {{"description", description}, {"schema", {{"type", "string"}}}};
}

// What a status carries beside its document.
Json fieldsOf(int status) {
    switch (status) {
    case 304:
        return {{"ETag", fieldJson("Of what the client has.")}};
    case 401:
    case 403:
        return {{"WWW-Authenticate", fieldJson("What is wrong with the credentials (RFC 6750).")}};
    case 412:
        return {{"ETag", fieldJson("Of what is there now.")}};
    case 416:
        return {{"Content-Range", fieldJson("How many bytes there are: bytes */N.")}};
    case 429:
    case 503:
        return {{"Retry-After", fieldJson("Seconds to wait, where that is known.")}};
    default:
        return nullptr;
    }
}

// "**Gone** (`version-gone`): …", one for each type of the status.
std::string meaningOf(int status) {
    std::string text;
    for (const ProblemType& type : problemTypes())
        if (type.status == status)
            text +=
                cat(text.empty() ? "" : "\n\n", "**", type.title, "** (`", type.name, "`): ", type.meaning);
    return text;
}

} // namespace

Json openApiProblem(int status) {
    Json response{{"description", status == 304 ? "What the client has is still right." : meaningOf(status)}};
    if (Json fields = fieldsOf(status); !fields.is_null())
        response["headers"] = std::move(fields);
    if (status != 304)
        response["content"] = {
            {"application/problem+json", {{"schema", {{"$ref", "#/components/schemas/Problem"}}}}}};
    return response;
}

} // namespace stipple::server
