#include "client/headless/http_redirect.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>

namespace stipple {

namespace {

// RFC 3986 §5.2.4.
std::string withoutDotSegments(std::string_view path) {
    std::string result;
    while (!path.empty()) {
        std::size_t end = std::min(path.find('/', 1), path.size());
        std::string_view segment = path.substr(0, end); // "/name"
        bool isLast = end == path.size();
        path.remove_prefix(end);
        if (segment == "/.." || segment == "/.") {
            if (segment == "/..")
                result.erase(std::min(result.rfind('/'), result.size()));
            if (isLast)
                result += '/';
        } else {
            result += segment;
        }
    }
    return result.empty() ? "/" : result;
}

// RFC 3986 §5.2.2, for references without a scheme and an authority.
std::string resolvedTarget(std::string_view base, std::string_view reference) {
    std::string_view basePath = base.substr(0, base.find('?'));
    std::size_t query = std::min(reference.find('?'), reference.size());
    std::string_view path = reference.substr(0, query);
    std::string_view rest = reference.substr(query);
    if (path.empty())
        return rest.empty() ? std::string(base) : cat(basePath, rest);
    if (path.front() == '/')
        return cat(withoutDotSegments(path), rest);
    std::string merged = cat(basePath.substr(0, basePath.rfind('/') + 1), path);
    return cat(withoutDotSegments(merged), rest);
}

} // namespace

bool isRedirect(unsigned status) {
    return status == 301 || status == 302 || status == 303 || status == 307 || status == 308;
}

bool isPermanentRedirect(unsigned status) {
    return status == 301 || status == 308;
}

Result<HttpUrl> redirectTarget(const HttpUrl& from, std::string_view location, const std::string& where) {
    auto refused = [&where](std::string what) {
        return Error{ErrorCode::networkFailed, std::move(what), where, "ask whoever runs the server"};
    };
    location = location.substr(0, location.find('#'));
    if (location.empty())
        return refused("the server redirects without saying where to");
    const char* scheme = from.isSecure ? "https:" : "http:";
    std::string address;
    if (looksLikeUrl(location))
        address = location;
    else if (location.starts_with("//"))
        address = cat(scheme, location);
    else
        address = cat(scheme, "//", from.authority, resolvedTarget(from.target, location));
    auto target = parseHttpUrl(address);
    if (!target)
        return refused("the server redirects to what is no http or https address");
    if (from.isSecure && !target->isSecure)
        return refused("the server redirects from https to http");
    return target;
}

std::string originOf(const HttpUrl& url) {
    std::string host = url.host;
    std::transform(host.begin(), host.end(), host.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return cat(url.isSecure ? "https://" : "http://", host, ":", url.port);
}

} // namespace stipple
