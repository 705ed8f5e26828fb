// The access log: a line for each request, in the format that log analysers read ("combined") or as JSON.
//
// What a client sends can't make a line of its own, nor move a terminal's cursor: control bytes, quotes,
// backslashes and bytes beyond ASCII are escaped, and texts are cut at 1024 bytes. Secrets are not in it:
// neither the field Authorization, nor the signature of an address, nor a token that somebody put into one;
// of Referer, what is before the "?".
#pragma once

#include "server/net/request_log.hpp"
#include "shared/base/result.hpp"

#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace stipple::server {

enum class LogFormat { combined, json };

// Without line ends.
//   127.0.0.1 - Lisa [31/Jan/2026:12:00:00 +0000] "GET /clouds/town.stipple HTTP/1.1" 206 65536 "-" "curl/8"
//   {"time":"2026-01-31T12:00:00.000Z","client":"127.0.0.1","user":"Lisa","method":"GET","target":"/clouds/…",
//    "version":"1.1","range":"bytes=0-65535","referer":"","userAgent":"curl/8","job":"","status":206,
//    "bytes":65536,"milliseconds":0.41,"complete":true}
std::string combinedLine(const RequestRecord& record);
std::string jsonLine(const RequestRecord& record);

// `text` with "..." for what follows "signature=", "token=" or "access_token=", however often the "=" is
// percent-encoded, up to the next parameter, and for the rest of what begins like a token of this program.
std::string withoutSecrets(std::string_view text);

// Thread: any. A line that can't be written (the disk is full) is lost; the server goes on.
class AccessLog {
  public:
    // `path` is appended to, and made readable to its owner and group; empty: standard error. Errors:
    // writeFailed.
    static Result<std::unique_ptr<AccessLog>> open(LogFormat format, const std::string& path);
    ~AccessLog();
    AccessLog(const AccessLog&) = delete;
    AccessLog& operator=(const AccessLog&) = delete;

    void write(const RequestRecord& record);
    // Opens the path again, for when the file was moved away (logrotate(8)). On an error the old file stays.
    Status reopen();

  private:
    AccessLog(LogFormat format, std::string path) : format_(format), path_(std::move(path)) {}
    Result<int> openFile() const;

    const LogFormat format_;
    const std::string path_;
    std::mutex mutex_;
    int descriptor_ = 2; // under mutex_
};

} // namespace stipple::server
