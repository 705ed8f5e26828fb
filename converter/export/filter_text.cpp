#include "converter/export/filter_text.hpp"

#include "shared/base/text.hpp"
#include "shared/select/cloud_filter.hpp"
#include "shared/select/region_options.hpp"

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

std::vector<std::string_view> split(std::string_view text, char separator = ',') {
    std::vector<std::string_view> parts;
    for (;;) {
        std::size_t comma = text.find(separator);
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

Result<ValueRange> rangeFromText(std::string_view text) {
    constexpr const char* advice = "give low..high, low.., ..high or one value";
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::size_t dots = text.find("..");
    std::string_view low = trimmed(text.substr(0, dots));
    std::string_view high = dots == std::string_view::npos ? low : trimmed(text.substr(dots + 2));
    if (low.empty() && high.empty())
        return invalid(text, "a range has a limit", advice);
    auto limitOf = [](std::string_view number, double open) {
        return number.empty() ? std::optional(open) : numberOf<double>(number);
    };
    auto first = limitOf(low, -infinity), last = limitOf(high, infinity);
    for (auto [number, value] : {std::pair{low, first}, {high, last}})
        if (!value || (!number.empty() && !std::isfinite(*value)))
            return invalid(text, cat("\"", number.substr(0, 40), "\" is no number"), advice);
    if (*first > *last)
        return invalid(text, "the range is empty", "give the smaller limit first");
    return ValueRange{*first, *last};
}

Result<std::vector<AttributeCondition>> conditionsFromText(std::string_view text) {
    constexpr const char* advice = "give Attribute:low..high, joined by semicolons";
    auto conditionOf = [](std::string_view part) -> Result<AttributeCondition> {
        std::size_t colon = part.rfind(':');
        if (colon == std::string_view::npos || trimmed(part.substr(0, colon)).empty())
            return invalid(part, "it names no attribute", advice);
        AttributeCondition condition{std::string(trimmed(part.substr(0, colon))), {}, true};
        for (std::string_view range : split(part.substr(colon + 1))) {
            STIPPLE_TRY(one, rangeFromText(range));
            condition.ranges.push_back(one);
        }
        return condition;
    };
    std::vector<AttributeCondition> conditions;
    std::size_t begin = 0;
    for (std::size_t end = text.find(';');; end = text.find(';', end + 1)) {
        bool isLast = end == std::string_view::npos;
        auto condition = conditionOf(text.substr(begin, isLast ? end : end - begin));
        if (condition)
            conditions.push_back(*std::move(condition));
        else if (isLast)
            return condition.error();
        if (isLast)
            return conditions;
        if (condition) // else the semicolon is one of the name
            begin = end + 1;
    }
}

Result<std::vector<Point2d>> lineFromText(std::string_view text) {
    constexpr const char* advice = "give x,y;x,y;…";
    std::vector<Point2d> line;
    for (std::string_view part : split(text, ';')) {
        std::vector<std::string_view> numbers = split(part);
        auto x = numberOf<double>(numbers.front()), y = numberOf<double>(numbers.back());
        if (numbers.size() != 2 || !x || !y || !std::isfinite(*x) || !std::isfinite(*y))
            return invalid(text, cat("\"", part.substr(0, 40), "\" is no point of a line"), advice);
        line.push_back({*x, *y});
    }
    if (line.size() < 2)
        return invalid(text, "a line has at least two points", advice);
    return line;
}

Result<std::vector<double>> numbersFromText(std::string_view text) {
    std::vector<double> numbers;
    for (std::string_view part : split(text)) {
        auto number = numberOf<double>(part);
        if (!number || !std::isfinite(*number))
            return invalid(text, cat("\"", part.substr(0, 40), "\" is no number"),
                           "give numbers joined by commas");
        numbers.push_back(*number);
    }
    return numbers;
}

Result<std::shared_ptr<const ConvexRegion>> rotatedBoxFromText(std::string_view text) {
    std::vector<std::string_view> parts = split(text, ';');
    if (parts.size() != 2 && parts.size() != 3)
        return invalid(text, "it is no rotated box",
                       "give x,y,z;dx,dy,dz;degrees, or without z and dz for any height");
    std::vector<std::vector<double>> numbers(3);
    for (std::size_t i = 0; i < parts.size(); ++i) {
        STIPPLE_TRY(one, numbersFromText(parts[i]));
        numbers[i] = std::move(one);
    }
    return rotatedBox(numbers[0], numbers[1], numbers[2]);
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
