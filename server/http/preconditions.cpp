#include "server/http/preconditions.hpp"

#include "server/http/entity_tag.hpp"
#include "shared/io/http_date.hpp"

#include <algorithm>

namespace stipple::server {

namespace {

// The date of a field that is one line and one valid date; anything else is ignored (§13.1.3, §13.1.4).
std::optional<std::int64_t> dateField(const HttpRequest& request, std::string_view name,
                                      std::int64_t nowSeconds) {
    if (request.count(name) != 1)
        return std::nullopt;
    return parseHttpDate(trimmed(*request.field(name)), nowSeconds);
}

bool ifMatch(std::string_view value, const Validators& validators) {
    auto list = parseEntityTagList(value);
    return list && (list->any || std::any_of(list->tags.begin(), list->tags.end(), [&](std::string_view tag) {
                        return strongMatch(tag, validators.etag);
                    }));
}

// A malformed list names no version: the answer is sent in full.
bool ifNoneMatch(std::string_view value, const Validators& validators) {
    auto list = parseEntityTagList(value);
    return !list ||
           !(list->any || std::any_of(list->tags.begin(), list->tags.end(),
                                      [&](std::string_view tag) { return weakMatch(tag, validators.etag); }));
}

} // namespace

Precondition evaluatePreconditions(const HttpRequest& request, const Validators& validators,
                                   std::int64_t nowSeconds) {
    bool datesCount = validators.lastModifiedSeconds != 0;
    if (auto value = request.field("If-Match")) {
        if (!ifMatch(*value, validators))
            return Precondition::failed;
    } else if (auto date = dateField(request, "If-Unmodified-Since", nowSeconds); date && datesCount) {
        if (validators.lastModifiedSeconds > *date)
            return Precondition::failed;
    }
    if (auto value = request.field("If-None-Match")) {
        if (!ifNoneMatch(*value, validators))
            return Precondition::notModified;
    } else if (auto date = dateField(request, "If-Modified-Since", nowSeconds); date && datesCount) {
        if (validators.lastModifiedSeconds <= *date)
            return Precondition::notModified;
    }
    return Precondition::passed;
}

bool rangeApplies(const HttpRequest& request, const Validators& validators, std::int64_t nowSeconds) {
    auto value = request.field("If-Range");
    if (!value)
        return true;
    if (request.count("If-Range") != 1)
        return false;
    std::string_view validator = trimmed(*value);
    if (validator.starts_with('"') || validator.starts_with("W/"))
        return strongMatch(validator, validators.etag);
    // A date is a strong validator only once the second in which the file changed is over (§8.8.2.2).
    auto date = parseHttpDate(validator, nowSeconds);
    return date && validators.lastModifiedSeconds != 0 && *date == validators.lastModifiedSeconds &&
           validators.lastModifiedSeconds < nowSeconds;
}

} // namespace stipple::server
