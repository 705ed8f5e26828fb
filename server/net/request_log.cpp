#include "server/net/request_log.hpp"

#include <cstdio>
#include <ctime>
#include <string_view>

namespace stipple::server {

namespace {

std::string escaped(std::string_view text) {
    constexpr std::size_t longest = 512;
    std::string safe;
    for (char c : text.substr(0, longest)) {
        auto byte = static_cast<unsigned char>(c);
        if (byte > 0x20 && byte < 0x7F && c != '"' && c != '\\') {
            safe += c;
        } else {
            char hex[8];
            std::snprintf(hex, sizeof hex, "\\x%02x", byte);
            safe += hex;
        }
    }
    return text.size() > longest ? safe + "..." : safe;
}

} // namespace

std::string formatRecord(const RequestRecord& record) {
    std::time_t seconds = static_cast<std::time_t>(record.timeMs / 1000);
    std::tm utc{};
    ::gmtime_r(&seconds, &utc);
    char time[40], numbers[96];
    std::size_t length = std::strftime(time, sizeof time, "%Y-%m-%dT%H:%M:%S", &utc);
    std::snprintf(time + length, sizeof time - length, ".%03dZ ", static_cast<int>(record.timeMs % 1000));
    std::snprintf(numbers, sizeof numbers, " status=%d bytes=%llu ms=%.2f", record.status,
                  static_cast<unsigned long long>(record.bodyBytes), record.milliseconds);
    std::string line = time + record.client + " " + escaped(record.method) + " " + escaped(record.target);
    if (!record.range.empty())
        line += " range=\"" + escaped(record.range) + "\"";
    line += numbers;
    return record.isComplete ? line : line + " cut";
}

} // namespace stipple::server
