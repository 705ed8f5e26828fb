#include "server/api/openapi_document.hpp"
#include "shared/base/text.hpp"

#include <cstdlib>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;

Json numbersJson(std::string_view text) {
    Json numbers = Json::array();
    for (std::string_view part : splitAt(text, ','))
        numbers.push_back(finiteNumber(part).value_or(0));
    return numbers;
}

// A value of a row as JSON has it.
Json valueJson(const Parameter& parameter, std::string_view text) {
    switch (parameter.kind) {
    case ParameterKind::count:
        return static_cast<std::uint64_t>(finiteNumber(text).value_or(0));
    case ParameterKind::number:
        return finiteNumber(text).value_or(0);
    case ParameterKind::numbers:
        return numbersJson(text);
    case ParameterKind::text:
    case ParameterKind::choice:
        return std::string(text);
    }
    return nullptr;
}

// As many numbers as one of the forms has names.
Json lengthsJson(std::string_view form) {
    Json lengths = Json::array();
    for (std::string_view one : splitAt(form, '|')) {
        std::size_t length = splitAt(one, ',').size();
        lengths.push_back({{"title", one}, {"minItems", length}, {"maxItems", length}});
    }
    return lengths;
}

Json schemaJson(const Parameter& parameter) {
    Json schema;
    switch (parameter.kind) {
    case ParameterKind::text:
        schema = {{"type", "string"}, {"minLength", 1}};
        if (!parameter.pattern.empty())
            schema["pattern"] = parameter.pattern;
        break;
    case ParameterKind::count:
        schema = {{"type", "integer"},
                  {"minimum", static_cast<std::uint64_t>(parameter.least)},
                  {"maximum", static_cast<std::uint64_t>(parameter.most)}};
        break;
    case ParameterKind::number:
        schema = {{"type", "number"}, {"minimum", parameter.least}, {"maximum", parameter.most}};
        break;
    case ParameterKind::numbers:
        schema = {{"type", "array"}, {"items", {{"type", "number"}}}, {"oneOf", lengthsJson(parameter.form)}};
        break;
    case ParameterKind::choice:
        schema = {{"type", "string"}, {"enum", parameter.choices}};
        break;
    }
    if (!parameter.usual.empty())
        schema["default"] = valueJson(parameter, parameter.usual);
    return schema;
}

} // namespace

Json openApiParameter(const Parameter& parameter) {
    Json json{{"name", parameter.name},
              {"in", "query"},
              {"required", parameter.isRequired},
              {"description", parameter.description},
              {"schema", schemaJson(parameter)}};
    if (parameter.kind == ParameterKind::numbers) { // joined by commas
        json["style"] = "form";
        json["explode"] = false;
    }
    if (!parameter.example.empty())
        json["example"] = valueJson(parameter, parameter.example);
    if (!parameter.needs.empty())
        json["x-needs"] = parameter.needs;
    return json;
}

} // namespace stipple::server
