#include "client/headless/http_url.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>

namespace stipple {

namespace {

Error badUrl(std::string_view url, std::string what) {
    return {ErrorCode::invalidArgument, std::move(what), std::string(url),
            "an address looks like http://host:8017/clouds/name.stipple"};
}

bool isPort(std::string_view text) {
    return !text.empty() && text.size() <= 5 &&
           std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; }) &&
           std::stoi(std::string(text)) >= 1 && std::stoi(std::string(text)) <= 65535;
}

} // namespace

bool looksLikeUrl(std::string_view text) {
    std::size_t colon = text.find("://");
    return colon != std::string_view::npos && colon > 0 &&
           std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == '+' || c == '-' || c == '.';
           });
}

Result<HttpUrl> parseHttpUrl(std::string_view url) {
    if (!looksLikeUrl(url))
        return badUrl(url, "is not an address");
    std::string scheme(url.substr(0, url.find("://")));
    std::transform(scheme.begin(), scheme.end(), scheme.begin(),
                   [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    if (scheme != "http" && scheme != "https")
        return Error{ErrorCode::unsupported, cat("the scheme \"", scheme, "\" is not supported"),
                     std::string(url), "use http or https, or download the file"};
    // Control bytes and spaces would end the request line or a field early.
    if (std::any_of(url.begin(), url.end(),
                    [](char c) { return static_cast<unsigned char>(c) <= ' ' || c == 127; }))
        return badUrl(url, "holds a space or a control byte");

    std::string_view rest = url.substr(url.find("://") + 3);
    rest = rest.substr(0, rest.find('#'));
    std::size_t authorityEnd = std::min(rest.find_first_of("/?"), rest.size());
    std::string_view authority = rest.substr(0, authorityEnd);
    std::string_view target = rest.substr(authorityEnd);
    if (authority.find('@') != std::string_view::npos)
        return badUrl(url, "holds a user name, which is not supported");

    HttpUrl parts;
    std::string_view host = authority, afterHost;
    if (!authority.empty() && authority.front() == '[') {
        std::size_t close = authority.find(']');
        if (close == std::string_view::npos)
            return badUrl(url, "has an IPv6 address without its \"]\"");
        host = authority.substr(1, close - 1);
        afterHost = authority.substr(close + 1);
    } else if (std::size_t colon = authority.find(':'); colon != std::string_view::npos) {
        host = authority.substr(0, colon);
        afterHost = authority.substr(colon);
    }
    if (host.empty())
        return badUrl(url, "names no host");
    if (!afterHost.empty() && (afterHost.front() != ':' || !isPort(afterHost.substr(1))))
        return badUrl(url, "has a port that is not 1 to 65535");

    parts.isSecure = scheme == "https";
    parts.host = host;
    parts.port = afterHost.empty() ? (parts.isSecure ? "443" : "80") : std::string(afterHost.substr(1));
    parts.authority = authority;
    parts.target = target.empty() || target.front() != '/' ? cat("/", target) : std::string(target);
    return parts;
}

} // namespace stipple
