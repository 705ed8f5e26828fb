// The document against the table of endpoints; the running server against the document is tests/openapi.
#include "server/api/openapi_document.hpp"
#include "shared/base/text.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>
#include <set>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;
using Json = nlohmann::ordered_json;

TEST_CASE("the document has every endpoint of the table, every parameter of it, and no other") {
    ApiFixture api;
    auto paths = api.ask("/api/v1/openapi.json").json["paths"];
    std::set<std::string> described, existing;
    for (const auto& [path, item] : paths.items())
        if (path.starts_with("/api/"))
            described.insert(path);
    for (const Endpoint& endpoint : endpoints()) {
        std::string path = cat("/api/v1", endpoint.path);
        INFO(path);
        existing.insert(path);
        std::set<std::string> names, documented;
        for (const Parameter& parameter : endpoint.parameters)
            names.insert(std::string(parameter.name));
        if (paths[path].contains("parameters"))
            for (const auto& parameter : paths[path]["parameters"])
                if (parameter["in"] == "query")
                    documented.insert(parameter["name"].get<std::string>());
        CHECK(names == documented);
        CHECK(paths[path]["get"]["operationId"] == std::string(endpoint.name));
        CHECK(paths[path]["get"]["responses"]["200"]["content"].size() == endpoint.formats.size());
    }
    CHECK(described == existing);
}

TEST_CASE("a row of the table becomes a parameter with its range, its usual value and its example") {
    Json count = openApiParameter({.name = "n",
                                   .description = "d",
                                   .kind = ParameterKind::count,
                                   .least = 1,
                                   .most = 9,
                                   .example = "3",
                                   .usual = "2"});
    CHECK(count == Json::parse(R"({"name": "n", "in": "query", "required": false, "description": "d",
        "schema": {"type": "integer", "minimum": 1, "maximum": 9, "default": 2}, "example": 3})"));
    Json numbers = openApiParameter({.name = "n",
                                     .description = "d",
                                     .kind = ParameterKind::numbers,
                                     .form = "x,y,z|x,y",
                                     .example = "1,2.5",
                                     .isRequired = true,
                                     .needs = "m=1"});
    CHECK(numbers == Json::parse(R"({"name": "n", "in": "query", "required": true, "description": "d",
        "schema": {"type": "array", "items": {"type": "number"}, "oneOf": [
            {"title": "x,y,z", "minItems": 3, "maxItems": 3}, {"title": "x,y", "minItems": 2, "maxItems": 2}]},
        "style": "form", "explode": false, "example": [1.0, 2.5], "x-needs": "m=1"})"));
}
