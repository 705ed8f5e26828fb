// The texts of the access log's lines.
#include "server/log/access_log.hpp"

#include "server/http/message.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

constexpr std::size_t longestText = 1024;

// Apache's way: \xHH, which analysers of the combined format read.
std::string escaped(std::string_view text, bool escapesSpaces) {
    std::string safe;
    for (char c : text.substr(0, longestText)) {
        auto byte = static_cast<unsigned char>(c);
        bool isPlain = byte >= 0x20 && byte < 0x7F && c != '"' && c != '\\' && !(escapesSpaces && c == ' ');
        if (isPlain) {
            safe += c;
        } else {
            char hex[8];
            std::snprintf(hex, sizeof hex, "\\x%02x", byte);
            safe += hex;
        }
    }
    return text.size() > longestText ? safe + "..." : safe;
}

std::string orDash(std::string text) {
    return text.empty() ? "-" : text;
}

std::string_view withoutQuery(std::string_view address) {
    return address.substr(0, address.find_first_of("?#"));
}

std::tm utcOf(std::int64_t timeMs) {
    std::time_t seconds = static_cast<std::time_t>(timeMs / 1000);
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    return utc;
}

// The length of "=" at the front of `text`, also as "%3D", "%253D" and so on; 0: it is something else.
std::size_t equalsLength(std::string_view text) {
    if (text.starts_with('='))
        return 1;
    if (!text.starts_with('%'))
        return 0;
    std::size_t at = 1;
    while (text.substr(at, 2) == "25")
        at += 2;
    return equalIgnoringCase(text.substr(at, 2), "3D") ? at + 2 : 0;
}

// The same for what ends a parameter: "&", "%26", "%2526", "#", a space.
bool endsParameter(std::string_view text) {
    if (text.front() == '&' || text.front() == '#' || text.front() == ' ')
        return true;
    if (text.front() != '%')
        return false;
    std::size_t at = 1;
    while (text.substr(at, 2) == "25")
        at += 2;
    return text.substr(at, 2) == "26";
}

// How much of the front of `text` may be shown before a secret follows; 0: none follows.
std::size_t lengthBeforeSecret(std::string_view text) {
    static constexpr std::array<std::string_view, 2> names{"signature", "token"};
    for (std::string_view name : names)
        if (equalIgnoringCase(text.substr(0, name.size()), name))
            if (std::size_t length = equalsLength(text.substr(name.size())))
                return name.size() + length;
    constexpr std::string_view tokenStart = "stipple_";
    return text.starts_with(tokenStart) ? tokenStart.size() : 0;
}

std::string combinedTime(std::int64_t timeMs) {
    // Not by strftime: the names of months must not follow the locale.
    static constexpr std::array<const char*, 12> months{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                                                        "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
    std::tm utc = utcOf(timeMs);
    char text[64];
    std::snprintf(text, sizeof text, "[%02d/%s/%04d:%02d:%02d:%02d +0000]", utc.tm_mday,
                  months[static_cast<std::size_t>(utc.tm_mon)], utc.tm_year + 1900, utc.tm_hour, utc.tm_min,
                  utc.tm_sec);
    return text;
}

std::string isoTime(std::int64_t timeMs) {
    std::tm utc = utcOf(timeMs);
    char text[80];
    std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", utc.tm_year + 1900,
                  utc.tm_mon + 1, utc.tm_mday, utc.tm_hour, utc.tm_min, utc.tm_sec,
                  static_cast<int>(timeMs % 1000));
    return text;
}

std::string versionText(int version) {
    return cat(version / 10, ".", version % 10);
}

} // namespace

std::string withoutSecrets(std::string_view text) {
    std::string shown;
    while (!text.empty()) {
        std::size_t length = lengthBeforeSecret(text);
        if (length == 0) {
            shown += text.front();
            text.remove_prefix(1);
            continue;
        }
        shown.append(text.substr(0, length)).append("...");
        text.remove_prefix(length);
        while (!text.empty() && !endsParameter(text))
            text.remove_prefix(1);
    }
    return shown;
}

std::string combinedLine(const RequestRecord& record) {
    bool isReadable = !record.method.empty(); // bytes that were no request have none
    std::string request =
        isReadable ? cat(escaped(record.method, true), " ", escaped(withoutSecrets(record.target), true),
                         " HTTP/", versionText(record.version))
                   : "-";
    return cat(orDash(record.client), " - ", orDash(escaped(record.user, true)), " ",
               combinedTime(record.timeMs), " \"", request, "\" ", record.status, " ",
               record.bodyBytes == 0 ? "-" : std::to_string(record.bodyBytes), " \"",
               orDash(escaped(withoutSecrets(withoutQuery(record.referer)), false)), "\" \"",
               orDash(escaped(withoutSecrets(record.userAgent), false)), "\"");
}

std::string jsonLine(const RequestRecord& record) {
    using Json = nlohmann::ordered_json;
    auto cut = [](std::string_view text) { return withoutSecrets(text).substr(0, longestText); };
    Json json{{"time", isoTime(record.timeMs)},
              {"client", record.client},
              {"user", record.user},
              {"method", cut(record.method)},
              {"target", cut(record.target)},
              {"version", versionText(record.version)},
              {"range", cut(record.range)},
              {"referer", cut(withoutQuery(record.referer))},
              {"userAgent", cut(record.userAgent)},
              {"job", record.job},
              {"status", record.status},
              {"bytes", record.bodyBytes},
              {"milliseconds", record.milliseconds},
              {"complete", record.isComplete}};
    return json.dump(-1, ' ', true, Json::error_handler_t::replace); // ASCII: \u escapes
}

} // namespace stipple::server
