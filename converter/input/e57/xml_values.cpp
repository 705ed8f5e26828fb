#include "converter/input/e57/xml_values.hpp"

#include "converter/input/e57/paged_file.hpp"
#include "shared/base/text.hpp"

#include <charconv>
#include <cmath>

namespace stipple::e57 {

namespace {
constexpr const char* mendAdvice = "write the file again from its source";
constexpr std::size_t quotedChars = 60; // of a value, in messages

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view spaces = " \t\r\n";
    std::size_t begin = text.find_first_not_of(spaces);
    if (begin == std::string_view::npos)
        return {};
    return text.substr(begin, text.find_last_not_of(spaces) - begin + 1);
}

template <class T>
std::optional<T> parseNumber(std::string_view text) {
    text = trimmed(text);
    if (text.size() > 1 && text[0] == '+')
        text.remove_prefix(1);
    T value{};
    auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end != text.data() + text.size())
        return std::nullopt;
    if constexpr (std::is_floating_point_v<T>)
        if (error == std::errc::result_out_of_range) // 1e-320, 1e400: the nearest that a double has
            return std::strtod(std::string(text).c_str(), nullptr);
    if (error != std::errc{})
        return std::nullopt;
    return value;
}

Error noNumber(const XmlElement& element, std::string_view what, std::string_view value) {
    return element.error(ErrorCode::corrupt,
                         cat(what, " \"", value.substr(0, quotedChars), "\" is no number of its type"));
}
} // namespace

std::vector<XmlElement> XmlElement::children() const {
    std::vector<XmlElement> result;
    for (pugi::xml_node child : node_.children())
        if (child.type() == pugi::node_element)
            result.emplace_back(child, xmlOffset_);
    return result;
}

std::string XmlElement::text() const {
    return std::string(trimmed(node_.child_value()));
}

Result<std::int64_t> XmlElement::integerAttribute(const char* name, std::int64_t absent) const {
    std::string_view value = attribute(name);
    if (value.empty())
        return absent;
    auto number = parseNumber<std::int64_t>(value);
    if (!number)
        return noNumber(*this, name, value);
    return *number;
}

Result<double> XmlElement::numberAttribute(const char* name, double absent) const {
    std::string_view value = attribute(name);
    if (value.empty())
        return absent;
    auto number = parseNumber<double>(value);
    if (!number || !std::isfinite(*number))
        return noNumber(*this, name, value);
    return *number;
}

Result<std::uint64_t> XmlElement::unsignedAttribute(const char* name) const {
    std::string_view value = attribute(name);
    if (value.empty())
        return error(ErrorCode::corrupt, cat("it has no ", name));
    auto number = parseNumber<std::uint64_t>(value);
    if (!number)
        return noNumber(*this, name, value);
    return *number;
}

Result<std::optional<double>> XmlElement::childNumber(const char* name) const {
    std::optional<double> result;
    XmlElement found = child(name);
    if (!found)
        return result;
    std::string text = found.text();
    auto number = text.empty() ? 0.0 : parseNumber<double>(text);
    if (!number)
        return noNumber(found, "its value", text);
    result = number;
    if (found.type() == "ScaledInteger") {
        STIPPLE_TRY(scale, found.numberAttribute("scale", 1));
        STIPPLE_TRY(offset, found.numberAttribute("offset", 0));
        result = *number * scale + offset;
    }
    return result;
}

Error XmlElement::error(ErrorCode code, const std::string& what) const {
    std::ptrdiff_t at = node_.offset_debug();
    std::string where = at < 0 ? "the XML section" : placeOf(xmlOffset_ + static_cast<std::uint64_t>(at));
    return {code, name().empty() ? what : cat("element ", name().substr(0, quotedChars), ": ", what), where,
            code == ErrorCode::corrupt ? mendAdvice : ""};
}

Status XmlText::parse(ByteSpan xml, std::uint64_t xmlOffset) {
    xmlOffset_ = xmlOffset;
    pugi::xml_parse_result parsed =
        document_.load_buffer(xml.data(), xml.size(), pugi::parse_default, pugi::encoding_utf8);
    if (parsed)
        return {};
    return Error{ErrorCode::corrupt, cat("the XML section can't be read: ", parsed.description()),
                 placeOf(xmlOffset + static_cast<std::uint64_t>(std::max<std::ptrdiff_t>(parsed.offset, 0))),
                 mendAdvice};
}

} // namespace stipple::e57
