#include "server/http/content_coding.hpp"

#include "server/http/message.hpp"

#include <algorithm>
#include <array>
#include <cctype>

namespace stipple::server {

namespace {

constexpr int fullQuality = 1000;

struct Element {
    std::string_view coding;
    int quality = fullQuality;
};

// weight's qvalue: "0" or "1", up to three digits behind a point, at most 1 (RFC 9110 §12.4.2).
std::optional<int> parseQuality(std::string_view text) {
    if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1') ||
        (text.size() > 1 && text[1] != '.'))
        return std::nullopt;
    int value = (text[0] - '0') * fullQuality;
    int unit = fullQuality / 10;
    for (char c : text.substr(std::min<std::size_t>(2, text.size()))) {
        if (c < '0' || c > '9')
            return std::nullopt;
        value += (c - '0') * unit;
        unit /= 10;
    }
    return value <= fullQuality ? std::optional<int>(value) : std::nullopt;
}

std::optional<Element> parseElement(std::string_view text) {
    std::size_t semicolon = std::min(text.find(';'), text.size());
    Element element{trimmed(text.substr(0, semicolon))};
    if (element.coding.empty() || element.coding.find_first_of(" \t=\"") != std::string_view::npos)
        return std::nullopt;
    if (semicolon == text.size())
        return element;
    std::string_view weight = trimmed(text.substr(semicolon + 1));
    if (weight.size() < 2 || (weight[0] != 'q' && weight[0] != 'Q') || weight[1] != '=')
        return std::nullopt;
    auto quality = parseQuality(weight.substr(2));
    if (!quality)
        return std::nullopt;
    element.quality = *quality;
    return element;
}

bool names(const Element& element, std::string_view coding) {
    return equalIgnoringCase(element.coding, coding) ||
           (coding == "gzip" && equalIgnoringCase(element.coding, "x-gzip"));
}

} // namespace

std::span<const ContentCoding> storedCodings() {
    static constexpr std::array codings{ContentCoding{"br", ".br"}, ContentCoding{"zstd", ".zst"},
                                        ContentCoding{"gzip", ".gz"}};
    return codings;
}

int codingQuality(const std::optional<std::string>& acceptEncoding, std::string_view coding) {
    bool isIdentity = coding == "identity";
    if (!acceptEncoding)
        return isIdentity ? fullQuality : 0;
    std::optional<int> named, others;
    for (std::string_view rest = *acceptEncoding; !rest.empty();) {
        std::size_t comma = std::min(rest.find(','), rest.size());
        auto element = parseElement(rest.substr(0, comma));
        rest.remove_prefix(std::min(comma + 1, rest.size()));
        if (!element)
            continue;
        if (names(*element, coding) && !named)
            named = element->quality;
        else if (element->coding == "*" && !others)
            others = element->quality;
    }
    if (named || others)
        return named ? *named : *others;
    return isIdentity ? 1 : 0;
}

} // namespace stipple::server
