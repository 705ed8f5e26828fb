#include "shared/cli/number_check.hpp"

#include "shared/base/text.hpp"

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace stipple::cli {

namespace {
constexpr std::string_view units = "KMGT";

// The text as a whole; nothing if it is no such number, also if a T can't hold it.
template <class T>
std::optional<T> parsed(std::string_view text) {
    if (text.starts_with('+'))
        text.remove_prefix(1);
    T value{};
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
        return std::nullopt;
    return value;
}

bool isInteger(std::string_view text) {
    if (text.starts_with('+') || text.starts_with('-'))
        text.remove_prefix(1);
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

// What is wrong with a text that is no finite number.
std::string notFinite(const std::string& text, const std::string& advice) {
    return cat("\"", text, "\" is ", parsed<double>(text) ? "no finite" : "no", " number: ", advice);
}

std::string checkWhole(const std::string& text, std::int64_t least, std::int64_t most) {
    const std::string advice = cat("give a whole number from ", least, " to ", most);
    if (!isInteger(text))
        return cat("\"", text, "\" is no whole number: ", advice);
    auto value = parsed<std::int64_t>(text);
    if (value && *value >= least && *value <= most)
        return {};
    bool isLow = value ? *value < least : text.starts_with('-');
    return cat(text, isLow ? " is too small: " : " is too large: ", advice);
}

std::string checkNumber(const std::string& text, double least, double most) {
    const std::string advice = cat("give a number from ", least, " to ", most);
    auto value = parsed<double>(text);
    if (!value || !std::isfinite(*value))
        return notFinite(text, advice);
    if (*value >= least && *value <= most)
        return {};
    return cat(text, *value < least ? " is too small: " : " is too large: ", advice);
}

std::string checkAbove(const std::string& text, double limit) {
    const std::string advice = cat("give one greater than ", limit);
    auto value = parsed<double>(text);
    if (!value || !std::isfinite(*value))
        return notFinite(text, advice);
    return *value > limit ? std::string() : cat(text, " is too small: ", advice);
}

// 67108864 as "64M"
std::string sizeText(std::uint64_t bytes) {
    std::size_t unit = 0;
    while (unit < units.size() && bytes >= 1024 && bytes % 1024 == 0) {
        bytes /= 1024;
        ++unit;
    }
    return unit == 0 ? cat(bytes, " bytes") : cat(bytes, units[unit - 1]);
}

// Bytes; nothing if the text is no size.
std::optional<double> bytesOf(std::string text) {
    for (char& c : text)
        c = static_cast<char>(c >= 'a' && c <= 'z' ? c - 'a' + 'A' : c);
    std::string_view number = text;
    if (number.ends_with('B'))
        number.remove_suffix(1);
    if (number.ends_with('I'))
        number.remove_suffix(1);
    double factor = 1;
    if (std::size_t unit = number.empty() ? units.npos : units.find(number.back()); unit != units.npos) {
        factor = std::ldexp(1.0, 10 * (static_cast<int>(unit) + 1));
        number.remove_suffix(1);
    }
    while (number.ends_with(' '))
        number.remove_suffix(1);
    auto value = parsed<double>(number);
    if (!value || !std::isfinite(*value) || *value < 0)
        return std::nullopt;
    return *value * factor;
}

std::string toBytes(std::string& text, std::uint64_t least, std::uint64_t most) {
    std::optional<double> bytes = bytesOf(text);
    if (!bytes)
        return cat("\"", text,
                   "\" is no size of memory: give a number with its unit, for example 512M or 2G");
    if (*bytes < static_cast<double>(least))
        return cat(text,
                   isInteger(text) ? " bytes are too little: give at least "
                                   : " is too little: give at least ",
                   sizeText(least), ", for example 512M or 2G");
    if (*bytes > static_cast<double>(most))
        return cat(text, " is more than any machine has: give at most ", sizeText(most));
    text = std::to_string(static_cast<std::uint64_t>(*bytes));
    return {};
}
} // namespace

CLI::Validator wholeNumber(std::int64_t least, std::int64_t most) {
    auto check = [least, most](std::string& text) { return checkWhole(text, least, most); };
    return CLI::Validator(check, cat(least, " to ", most));
}

CLI::Validator number(double least, double most) {
    auto check = [least, most](std::string& text) { return checkNumber(text, least, most); };
    return CLI::Validator(check, cat(least, " to ", most));
}

CLI::Validator numberAbove(double limit) {
    auto check = [limit](std::string& text) { return checkAbove(text, limit); };
    return CLI::Validator(check, cat("greater than ", limit));
}

CLI::Validator memorySize(std::uint64_t leastBytes, std::uint64_t mostBytes) {
    auto check = [leastBytes, mostBytes](std::string& text) { return toBytes(text, leastBytes, mostBytes); };
    return CLI::Validator(check, cat("at least ", sizeText(leastBytes)));
}

} // namespace stipple::cli
