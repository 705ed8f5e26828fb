#include "server/upstream/upstream_tokens.hpp"

#include "client/headless/http_redirect.hpp"
#include "server/files/open_file.hpp"
#include "shared/base/text.hpp"

#include <sys/stat.h>
#include <vector>

namespace stipple::server {

namespace {

constexpr std::uint64_t maxFileBytes = 1 << 20;

std::vector<std::string_view> wordsOf(std::string_view line) {
    std::vector<std::string_view> words;
    constexpr const char* blanks = " \t\r";
    for (std::size_t at = line.find_first_not_of(blanks); at < line.size();) {
        std::size_t end = std::min(line.find_first_of(blanks, at), line.size());
        words.push_back(line.substr(at, end - at));
        at = line.find_first_not_of(blanks, end);
    }
    return words;
}

// b64token of RFC 6750 §2.1, and so nothing that could end a field.
bool isToken(std::string_view text) {
    std::size_t end = text.find_last_not_of('=');
    constexpr const char* allowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~+/";
    return end != std::string_view::npos &&
           text.substr(0, end + 1).find_first_not_of(allowed) == std::string_view::npos;
}

} // namespace

Result<UpstreamTokens> UpstreamTokens::parse(std::string_view text) {
    UpstreamTokens tokens;
    for (int number = 1; !text.empty(); ++number) {
        std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        std::vector<std::string_view> words = wordsOf(line.substr(0, line.find('#')));
        if (words.empty())
            continue;
        // The line may hold a token, so it is not shown.
        auto wrong = [number](const char* what) {
            return Error{ErrorCode::invalidArgument, what, cat("line ", number),
                         "write an origin and its token: https://example.org TOKEN"};
        };
        auto url = parseHttpUrl(words.front());
        if (!url || url->target != "/" || words.front().ends_with('/'))
            return wrong("it does not begin with an origin");
        if (words.size() != 2 || !isToken(words.back()))
            return wrong("its second word is not the token (RFC 6750), or not the last");
        if (!tokens.tokens_.emplace(originOf(*url), words.back()).second)
            return wrong("the origin has a token already");
    }
    return tokens;
}

Result<UpstreamTokens> UpstreamTokens::load(const std::string& path) {
    STIPPLE_TRY(file, OpenFile::open(path));
    struct stat status {};
    if (::fstat(file->descriptor(), &status) == 0 && (status.st_mode & S_IROTH) != 0)
        return Error{ErrorCode::invalidArgument, "every user of this machine can read its tokens", path,
                     "chmod o= on it"};
    if (file->identity().sizeBytes > maxFileBytes)
        return Error{ErrorCode::limitExceeded, "is larger than 1 MiB", path, ""};
    std::string text(static_cast<std::size_t>(file->identity().sizeBytes), '\0');
    if (!file->readAt(0, text.data(), text.size()))
        return Error{ErrorCode::ioFailed, "can't be read", path, ""};
    auto tokens = parse(text);
    if (!tokens)
        return tokens.error().at(path);
    return tokens;
}

std::string UpstreamTokens::of(const std::string& origin) const {
    auto found = tokens_.find(origin);
    return found == tokens_.end() ? std::string() : found->second;
}

} // namespace stipple::server
