#include "server/api/query.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace stipple::server {

namespace {

int hexValue(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

// Nothing where a "%" is not followed by two hexadecimal digits.
std::optional<std::string> decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i] == '+' ? ' ' : text[i];
            continue;
        }
        int high = i + 2 < text.size() ? hexValue(text[i + 1]) : -1;
        int low = i + 2 < text.size() ? hexValue(text[i + 2]) : -1;
        if (high < 0 || low < 0)
            return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

// Length of the well-formed UTF-8 character that `text` begins with (RFC 3629 §4); 0 if there is none.
std::size_t characterLength(std::string_view text) {
    auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
    auto follows = [&](std::size_t i, unsigned low = 0x80, unsigned high = 0xBF) {
        return byte(i) >= low && byte(i) <= high;
    };
    unsigned first = byte(0);
    if (first < 0x80)
        return text.empty() ? 0 : 1;
    if (first >= 0xC2 && first <= 0xDF)
        return follows(1) ? 2 : 0;
    if (first >= 0xE0 && first <= 0xEF) // neither overlong nor a surrogate
        return follows(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && follows(2) ? 3 : 0;
    if (first >= 0xF0 && first <= 0xF4) // neither overlong nor beyond U+10FFFF
        return follows(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && follows(2) &&
                       follows(3)
                   ? 4
                   : 0;
    return 0;
}

bool isPlainText(std::string_view text) {
    while (!text.empty()) {
        std::size_t length = characterLength(text);
        auto byte = static_cast<unsigned char>(text.front());
        bool isControl = byte == 0x7F || (byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r');
        if (length == 0 || isControl)
            return false;
        text.remove_prefix(length);
    }
    return true;
}

std::string joined(std::span<const std::string_view> parts) {
    std::string text;
    for (std::string_view part : parts)
        text.append(text.empty() ? "" : ", ").append(part);
    return text;
}

// The shortest text that reads back equal.
std::string shortest(double value) {
    char buffer[40];
    auto [end, error] = std::to_chars(buffer, buffer + sizeof buffer, value);
    return std::string(buffer, error == std::errc() ? end : buffer);
}

std::string rangeText(double least, double most) {
    constexpr double largest = std::numeric_limits<double>::max();
    if (least == -largest && most == largest)
        return "give a finite number";
    if (most == largest)
        return cat("give a number, at least ", shortest(least));
    if (least == -largest)
        return cat("give a number, at most ", shortest(most));
    return cat("give a number from ", shortest(least), " to ", shortest(most));
}

Result<std::pair<std::string, std::string>> parsedParameter(std::string_view part) {
    std::size_t equals = part.find('=');
    auto name = decoded(part.substr(0, equals));
    if (!name || !isPlainText(*name))
        return parameterError("",
                              cat("the name of a parameter, ", quotedValue(part.substr(0, equals)),
                                  ", is not percent-encoded UTF-8"),
                              "");
    if (name->empty())
        return parameterError("", cat("the query has a part without a name: ", quotedValue(part)),
                              "write name=value, joined by &");
    if (equals == std::string_view::npos || equals + 1 == part.size())
        return parameterError(*name, "it has no value", "write name=value");
    auto value = decoded(part.substr(equals + 1));
    if (!value || !isPlainText(*value))
        return parameterError(*name, "its value is not percent-encoded UTF-8",
                              "write % and two hexadecimal digits for each byte that is no letter or digit");
    return std::pair{*std::move(name), *std::move(value)};
}

} // namespace

Error parameterError(std::string_view name, std::string what, std::string allowed) {
    return {ErrorCode::invalidArgument, std::move(what), std::string(name), std::move(allowed)};
}

std::optional<double> finiteNumber(std::string_view text) {
    double value = 0;
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    bool isAll = error == std::errc() && end == text.data() + text.size();
    return isAll && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::vector<std::string_view> splitAt(std::string_view text, char separator) {
    std::vector<std::string_view> parts;
    for (;;) {
        std::size_t at = text.find(separator);
        parts.push_back(text.substr(0, at));
        if (at == std::string_view::npos)
            return parts;
        text.remove_prefix(at + 1);
    }
}

std::string quotedValue(std::string_view text) {
    constexpr std::size_t limit = 60;
    std::size_t shown = 0;
    while (shown < text.size()) {
        std::size_t length = std::max<std::size_t>(1, characterLength(text.substr(shown)));
        if (shown + length > limit)
            break;
        shown += length;
    }
    return cat("\"", text.substr(0, shown), shown < text.size() ? "…" : "", "\"");
}

Result<Query> Query::parse(std::string_view text) {
    Query query;
    if (text.empty())
        return query;
    for (std::string_view part : splitAt(text, '&')) {
        if (query.parameters_.size() == maxQueryParameters)
            return parameterError("", cat("the query has more than ", maxQueryParameters, " parameters"), "");
        STIPPLE_TRY(parameter, parsedParameter(part));
        if (query.has(parameter.first))
            return parameterError(parameter.first, "it is given twice", "give it once");
        query.parameters_.push_back(std::move(parameter));
    }
    return query;
}

Status Query::allowOnly(std::span<const std::string_view> names) const {
    for (const auto& [name, value] : parameters_)
        if (std::find(names.begin(), names.end(), name) == names.end())
            return parameterError(name, "there is no such parameter here",
                                  names.size() == 0 ? "this address takes none"
                                                    : cat("there are ", joined(names)));
    return {};
}

const std::string* Query::find(std::string_view name) const {
    for (const auto& [parameter, value] : parameters_)
        if (parameter == name)
            return &value;
    return nullptr;
}

Result<std::optional<double>> Query::number(std::string_view name, double least, double most) const {
    const std::string* text = find(name);
    if (!text)
        return std::optional<double>();
    auto value = finiteNumber(*text);
    if (!value)
        return parameterError(name, cat(quotedValue(*text), " is no finite number"), rangeText(least, most));
    if (*value < least || *value > most)
        return parameterError(name, cat(quotedValue(*text), " is out of range"), rangeText(least, most));
    return value;
}

Result<std::optional<std::uint64_t>> Query::count(std::string_view name, std::uint64_t least,
                                                  std::uint64_t most) const {
    const std::string* text = find(name);
    if (!text)
        return std::optional<std::uint64_t>();
    std::uint64_t value = 0;
    auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    bool isWhole = end == text->data() + text->size() && error != std::errc::invalid_argument;
    if (!isWhole || error != std::errc() || value < least || value > most)
        return parameterError(name,
                              cat(quotedValue(*text), isWhole ? " is out of range" : " is no whole number"),
                              cat("give a whole number from ", least, " to ", most));
    return std::optional(value);
}

Result<std::optional<std::vector<double>>> Query::numbers(std::string_view name,
                                                          std::string_view form) const {
    const std::string* text = find(name);
    if (!text)
        return std::optional<std::vector<double>>();
    std::string advice = "give ";
    for (std::size_t i = 0; i < form.size(); ++i)
        advice += form[i] == '|' ? " or " : std::string(1, form[i]);
    std::vector<double> values;
    for (std::string_view part : splitAt(*text, ',')) {
        auto value = finiteNumber(part);
        if (!value)
            return parameterError(name, cat(quotedValue(part), " is no finite number"), advice);
        values.push_back(*value);
    }
    for (std::string_view one : splitAt(form, '|'))
        if (splitAt(one, ',').size() == values.size())
            return std::optional(std::move(values));
    return parameterError(name, cat("it has ", values.size(), values.size() == 1 ? " number" : " numbers"),
                          advice);
}

Result<std::optional<std::size_t>> Query::choice(std::string_view name,
                                                 std::span<const std::string_view> choices) const {
    const std::string* text = find(name);
    if (!text)
        return std::optional<std::size_t>();
    auto place = std::find(choices.begin(), choices.end(), *text);
    if (place == choices.end())
        return parameterError(name, cat(quotedValue(*text), " is not known"),
                              cat("choose one of ", joined(choices)));
    return std::optional(static_cast<std::size_t>(place - choices.begin()));
}

} // namespace stipple::server
