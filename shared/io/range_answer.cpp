#include "shared/io/range_answer.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace stipple {
namespace {

constexpr const char* timeoutText = "the server did not answer in time";
constexpr const char* reloadAdvice = "open it again";
constexpr const char* rangeAdvice =
    "serve the file with `stipple serve`, or with any server that answers byte ranges";
constexpr const char* exposeAdvice =
    "from another host, it must expose the header: Access-Control-Expose-Headers: Content-Range, ETag";
constexpr int longestPauseSeconds = 3600; // that a server can ask for

// RFC 9110 §14.4: "bytes first-last/size" or "bytes */size"; a size of "*" is unknown.
struct ContentRange {
    bool satisfied = false;
    std::uint64_t first = 0, last = 0;
    std::optional<std::uint64_t> sizeBytes;
};

bool takeNumber(std::string_view& text, std::uint64_t& value) {
    auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (problem != std::errc{})
        return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool take(std::string_view& text, std::string_view part) {
    if (!text.starts_with(part))
        return false;
    text.remove_prefix(part.size());
    return true;
}

std::optional<ContentRange> parseContentRange(std::string_view text) {
    ContentRange range;
    if (!take(text, "bytes "))
        return std::nullopt;
    if (!take(text, "*")) {
        range.satisfied = true;
        if (!takeNumber(text, range.first) || !take(text, "-") || !takeNumber(text, range.last))
            return std::nullopt;
    }
    if (!take(text, "/"))
        return std::nullopt;
    if (!take(text, "*")) {
        std::uint64_t size = 0;
        if (!takeNumber(text, size))
            return std::nullopt;
        range.sizeBytes = size;
    }
    bool inOrder = !range.satisfied ||
                   (range.first <= range.last && (!range.sizeBytes || range.last < *range.sizeBytes));
    return text.empty() && inOrder ? std::optional(range) : std::nullopt;
}

Error changedError(const std::string& where) {
    return {ErrorCode::changed, say("the file was replaced while it was being read"), where, reloadAdvice};
}

// A validator that only one side has says nothing.
bool differs(const std::string& pinned, const std::string& now) {
    return !pinned.empty() && !now.empty() && pinned != now;
}

Status checkVersion(const RangeAnswer& answer, std::optional<std::uint64_t> sizeBytes, FileVersion& version,
                    const std::string& where) {
    if (version.pinned) {
        bool bySize = version.sizeBytes != 0 && sizeBytes && *sizeBytes != version.sizeBytes;
        bool byDate = version.etag.empty() && differs(version.lastModified, answer.lastModified);
        if (bySize || byDate || differs(version.etag, answer.etag))
            return changedError(where);
    } else {
        version = {answer.etag, answer.lastModified, sizeBytes.value_or(0), true};
    }
    return {};
}

Result<std::uint64_t> judgePart(ByteRange asked, const RangeAnswer& answer, FileVersion& version,
                                const std::string& where) {
    std::optional<ContentRange> part = parseContentRange(answer.contentRange);
    if (!part && answer.contentRange.empty()) {
        // Who has said it before has an error now; who has not never will.
        ErrorCode code = version.pinned ? ErrorCode::networkFailed : ErrorCode::unsupported;
        return Error{code, "the server sent a part of the file without saying which", where, exposeAdvice};
    }
    if (!part || !part->satisfied)
        return Error{ErrorCode::networkFailed,
                     say("the server's Content-Range \"", answer.contentRange, "\" is no range"), where,
                     rangeAdvice};
    STIPPLE_CHECK(checkVersion(answer, part->sizeBytes, version, where));
    // A part may end early only at the end of the file.
    std::uint64_t fileEnd = part->sizeBytes.value_or(asked.end());
    if (part->first != asked.offset || part->last + 1 != std::min(asked.end(), fileEnd))
        return Error{ErrorCode::networkFailed,
                     say("asked for bytes ", asked.offset, " to ", asked.end() - 1, ", the server sent \"",
                         answer.contentRange, "\""),
                     where, rangeAdvice};
    return part->last - part->first + 1;
}

Result<std::uint64_t> judgeWhole(ByteRange asked, const RangeAnswer& answer, FileVersion& version,
                                 const std::string& where) {
    if (version.pinned)
        STIPPLE_CHECK(checkVersion(answer, answer.contentLength, version, where));
    if (asked.offset == 0 && answer.contentLength && *answer.contentLength <= asked.size) {
        STIPPLE_CHECK(checkVersion(answer, answer.contentLength, version, where));
        return *answer.contentLength;
    }
    return Error{ErrorCode::unsupported, say("the server ignores Range and sends the whole file"), where,
                 rangeAdvice};
}

Error accessError(int status, const std::string& where) {
    if (status == 401)
        return {ErrorCode::accessDenied, say("the server wants to know who asks (status 401)"), where,
                say("give a token that it accepts, or an address that has one in it")};
    return {ErrorCode::accessDenied, say("the server refuses access (status 403)"), where,
            say("ask for the right to read it; the address may be signed and have expired")};
}

// What is no whole number is taken as if the field weren't there.
int secondsOf(std::string_view retryAfter) {
    std::uint64_t seconds = 0;
    if (!takeNumber(retryAfter, seconds) || !retryAfter.empty())
        return 0;
    return static_cast<int>(std::min<std::uint64_t>(seconds, longestPauseSeconds));
}

Error statusError(const RangeAnswer& answer, const std::string& where) {
    Error error{ErrorCode::networkFailed, say("the server answered with status ", answer.status), where,
                say("try again later")};
    if (answer.status == 429)
        error.what = say("the server has had too many requests (status 429)");
    if (answer.status == 503)
        error.what = say("the server is busy or away (status 503)");
    error.retryAfterSeconds = secondsOf(answer.retryAfter);
    return error;
}

} // namespace

std::string versionCaution(const FileVersion& version) {
    if (!version.pinned)
        return {};
    if (version.etag.starts_with("W/"))
        return say("its server names versions by a weak ETag only: bytes that change may go unnoticed");
    if (version.etag.empty() && version.lastModified.empty())
        return say("its server names no version of it (no ETag and no Last-Modified, or they are hidden): a "
                   "replacement of the same size goes unnoticed");
    if (version.etag.empty())
        return say("its server names no version of it but the date (no ETag, or it is hidden): a replacement "
                   "within a second goes unnoticed");
    return {};
}

std::string rangeField(ByteRange range) {
    return cat("bytes=", range.offset, "-", range.end() - 1);
}

Result<std::uint64_t> judgeRangeAnswer(ByteRange asked, const RangeAnswer& answer, FileVersion& version,
                                       const std::string& where) {
    switch (answer.status) {
    case 206:
        return judgePart(asked, answer, version, where);
    case 200:
        return judgeWhole(asked, answer, version, where);
    case 404:
    case 410:
        if (version.pinned)
            return Error{ErrorCode::changed, say("the file was removed while it was being read"), where,
                         reloadAdvice};
        return Error{ErrorCode::notFound, say("there is no such file on the server"), where,
                     say("check the address")};
    case 412:
        return changedError(where);
    case 416: {
        std::optional<ContentRange> range = parseContentRange(answer.contentRange);
        if (range)
            STIPPLE_CHECK(checkVersion(answer, range->sizeBytes, version, where));
        return Error{ErrorCode::truncated,
                     range && range->sizeBytes ? say("the file ends before byte ", asked.offset, ", after ",
                                                     *range->sizeBytes, " bytes")
                                               : say("the file ends before byte ", asked.offset),
                     where, say("copy or convert it again")};
    }
    case 401:
    case 403:
        return accessError(answer.status, where);
    default:
        return statusError(answer, where);
    }
}

Error noAnswerInTime(const std::string& where) {
    return {ErrorCode::networkFailed, timeoutText, where, say("try again")};
}

bool isTimeout(const Error& error) {
    return error.code == ErrorCode::networkFailed && error.what == timeoutText;
}

} // namespace stipple
