#include "server/http/negotiation.hpp"

#include "server/http/problem.hpp"
#include "shared/base/text.hpp"

#include <algorithm>

namespace stipple::server {

namespace {

struct MediaRange {
    std::string_view type;
    int quality = 1000; // thousandths
};

// "0", "0.5", "1.000": at most three decimals. -1 for anything else.
int parseQuality(std::string_view text) {
    if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1'))
        return -1;
    int thousandths = (text[0] - '0') * 1000, place = 100;
    if (text.size() > 1 && text[1] != '.')
        return -1;
    for (std::size_t i = 2; i < text.size(); ++i, place /= 10) {
        if (text[i] < '0' || text[i] > '9')
            return -1;
        thousandths += (text[i] - '0') * place;
    }
    return thousandths <= 1000 ? thousandths : -1;
}

// Takes what stands before the next `separator` off the front of `text`; separators in quotes don't count.
std::string_view takeUntil(char separator, std::string_view& text) {
    bool isQuoted = false;
    std::size_t at = 0;
    for (; at < text.size() && (isQuoted || text[at] != separator); ++at) {
        if (text[at] == '\\' && isQuoted)
            ++at;
        else if (text[at] == '"')
            isQuoted = !isQuoted;
    }
    at = std::min(at, text.size());
    std::string_view part = trimmed(text.substr(0, at));
    text.remove_prefix(std::min(at + 1, text.size()));
    return part;
}

std::optional<MediaRange> parseMediaRange(std::string_view element) {
    MediaRange range;
    range.type = takeUntil(';', element);
    if (std::count(range.type.begin(), range.type.end(), '/') != 1)
        return std::nullopt;
    while (!element.empty()) {
        std::string_view parameter = takeUntil(';', element);
        if (parameter.size() > 2 && equalIgnoringCase(parameter.substr(0, 2), "q="))
            range.quality = parseQuality(parameter.substr(2));
    }
    return range.quality < 0 ? std::nullopt : std::optional(range);
}

// How closely a range names a type: 3 exactly, 2 "text/*", 1 "*/*", 0 not at all.
int specificity(std::string_view range, std::string_view type) {
    if (equalIgnoringCase(range, type))
        return 3;
    if (range == "*/*")
        return 1;
    std::size_t slash = range.find('/');
    bool isSameFamily = range.substr(slash) == "/*" &&
                        equalIgnoringCase(range.substr(0, slash), type.substr(0, type.find('/')));
    return isSameFamily ? 2 : 0;
}

int qualityOf(std::string_view type, const std::vector<MediaRange>& ranges) {
    int best = 0, quality = 0;
    for (const MediaRange& range : ranges)
        if (int closeness = specificity(range.type, type); closeness > best) {
            best = closeness;
            quality = range.quality;
        }
    return quality;
}

} // namespace

std::optional<std::size_t> acceptedFormat(std::string_view accept, std::span<const Format> offers) {
    std::vector<MediaRange> ranges;
    while (!accept.empty())
        if (auto range = parseMediaRange(takeUntil(',', accept)))
            ranges.push_back(*range);
    if (ranges.empty())
        return 0;
    std::optional<std::size_t> best;
    int bestQuality = 0;
    for (std::size_t i = 0; i < offers.size(); ++i)
        if (int quality = qualityOf(offers[i].mediaType, ranges); quality > bestQuality) {
            best = i;
            bestQuality = quality;
        }
    return best;
}

std::variant<ChosenFormat, HttpResponse> chooseFormat(const HttpRequest& request, std::string_view name,
                                                      std::span<const Format> offers) {
    std::string names;
    std::vector<std::string> types;
    for (const Format& offer : offers) {
        if (!name.empty() && offer.name == name)
            return ChosenFormat{&offer, false};
        names += cat(names.empty() ? "" : ", ", offer.name);
        types.emplace_back(offer.mediaType);
    }
    if (!name.empty())
        return problemResponse({problem_types::invalidParameter,
                                cat("\"", name, "\" is no format of this endpoint; it has ", names),
                                "format"});
    if (auto index = acceptedFormat(request.field("Accept").value_or(""), offers))
        return ChosenFormat{&offers[*index], true};
    HttpResponse refusal = problemResponse(
        {problem_types::notAcceptable,
         cat("this endpoint has none of the media types that Accept names; ?format= takes ", names), "",
         types});
    refusal.addToList("Vary", "Accept");
    return refusal;
}

} // namespace stipple::server
