#include "converter/export/filter_text.hpp"

#include "converter/export/cloud_filter.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>

namespace stipple {

namespace {

Error invalid(std::string_view text, std::string what, std::string advice) {
    return {ErrorCode::invalidArgument, std::move(what), cat("\"", text.substr(0, 200), "\""),
            std::move(advice)};
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && text.front() == ' ')
        text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ')
        text.remove_suffix(1);
    return text;
}

std::vector<std::string_view> split(std::string_view text) {
    std::vector<std::string_view> parts;
    for (;;) {
        std::size_t comma = text.find(',');
        parts.push_back(trimmed(text.substr(0, comma)));
        if (comma == std::string_view::npos)
            return parts;
        text.remove_prefix(comma + 1);
    }
}

template <class T>
std::optional<T> numberOf(std::string_view text) {
    if (!text.empty() && text.front() == '+')
        text.remove_prefix(1);
    T value{};
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

} // namespace

Result<BoxD> boxFromText(std::string_view text) {
    constexpr const char* advice = "give xmin,ymin,xmax,ymax or xmin,ymin,zmin,xmax,ymax,zmax";
    std::vector<double> numbers;
    for (std::string_view part : split(text)) {
        auto number = numberOf<double>(part);
        if (!number || std::isnan(*number))
            return invalid(text, cat("\"", part.substr(0, 40), "\" is no number of a box"), advice);
        numbers.push_back(*number);
    }
    if (numbers.size() != 4 && numbers.size() != 6)
        return invalid(text, cat("a box has four or six numbers, not ", numbers.size()), advice);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    if (numbers.size() == 4)
        return BoxD{{numbers[0], numbers[1], -infinity}, {numbers[2], numbers[3], infinity}};
    return BoxD{{numbers[0], numbers[1], numbers[2]}, {numbers[3], numbers[4], numbers[5]}};
}

Result<std::vector<ValueRange>> rangesFromText(std::string_view text) {
    std::vector<ValueRange> ranges;
    for (std::string_view part : split(text)) {
        std::size_t dash = part.find('-');
        auto first = numberOf<std::uint32_t>(trimmed(part.substr(0, dash)));
        auto last =
            dash == std::string_view::npos ? first : numberOf<std::uint32_t>(trimmed(part.substr(dash + 1)));
        if (!first || !last || *first > *last)
            return invalid(text, cat("\"", part.substr(0, 40), "\" is no class and no range of classes"),
                           "give numbers and ranges, such as 2,6 or 3-5");
        ranges.push_back({static_cast<double>(*first), static_cast<double>(*last)});
    }
    return ranges;
}

Result<std::vector<int>> attributesFromTexts(const Schema& schema, const std::vector<std::string>& texts) {
    std::vector<int> attributes;
    auto add = [&](int attribute) {
        if (std::find(attributes.begin(), attributes.end(), attribute) == attributes.end())
            attributes.push_back(attribute);
    };
    for (const std::string& text : texts) {
        if (int whole = schema.find(text); whole >= 0) {
            add(whole);
            continue;
        }
        for (std::string_view part : split(text)) {
            if (part.empty())
                continue;
            STIPPLE_TRY(attribute, findAttribute(schema, std::string(part)));
            add(attribute);
        }
    }
    return attributes;
}

} // namespace stipple
