#include "server/http/cors.hpp"

#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>

namespace stipple::server {

namespace {

bool isDigits(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// A name, an IPv4 address, or an IPv6 address in brackets.
bool isHost(std::string_view text) {
    bool inBrackets = text.size() > 2 && text.front() == '[' && text.back() == ']';
    if (inBrackets)
        return text.find_first_not_of("0123456789abcdef:.", 1) == text.size() - 1;
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' || c == '_';
    });
}

} // namespace

Result<std::string> parseOrigin(std::string_view text) {
    Error wrong{ErrorCode::invalidArgument, "is no origin", std::string(text),
                "write it as browsers do: https://example.org, or with a port: http://localhost:8080"};
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    std::size_t schemeEnd = lower.find("://");
    std::string scheme = lower.substr(0, schemeEnd);
    if (schemeEnd == std::string::npos || (scheme != "http" && scheme != "https"))
        return wrong;
    std::string host = lower.substr(schemeEnd + 3), port;
    if (std::size_t colon = host.rfind(':'); colon != std::string::npos && !host.ends_with(']')) {
        port = host.substr(colon + 1);
        host.erase(colon);
        if (!isDigits(port) || port.size() > 5 || port.front() == '0' || std::stoul(port) > 65535)
            return wrong;
    }
    if (!isHost(host))
        return wrong;
    bool isUsualPort = port.empty() || port == (scheme == "http" ? "80" : "443");
    return isUsualPort ? cat(scheme, "://", host) : cat(scheme, "://", host, ":", port);
}

Result<CorsRules> CorsRules::listing(const std::vector<std::string>& origins, PublicFor publicFor) {
    CorsRules rules;
    rules.publicFor_ = publicFor;
    for (const std::string& text : origins) {
        if (text == "*") {
            rules.listsAll_ = true;
            continue;
        }
        STIPPLE_TRY(origin, parseOrigin(text));
        rules.origins_.push_back(origin);
    }
    return rules;
}

bool CorsRules::lists(std::string_view origin) const {
    return listsAll_ || std::find(origins_.begin(), origins_.end(), origin) != origins_.end();
}

void CorsRules::complete(const HttpRequest& request, HttpResponse& response, bool isForAll) const {
    if (listsAll_ || (isForAll && isPublicForAll())) {
        response.set("Access-Control-Allow-Origin", "*");
    } else {
        response.addToList("Vary", "Origin");
        std::string origin = request.field("Origin").value_or("");
        if (!lists(origin))
            return;
        response.set("Access-Control-Allow-Origin", origin);
    }
    response.set("Access-Control-Expose-Headers",
                 "Accept-Ranges, Content-Length, Content-Range, ETag, Last-Modified, Link, Retry-After, "
                 "WWW-Authenticate");
    for (const char* own : {"Content-Disposition", "Stipple-Point-Count"})
        if (!response.field(own).empty())
            response.addToList("Access-Control-Expose-Headers", own);
}

HttpResponse preflightResponse(const std::string& allowedMethods) {
    HttpResponse response;
    response.status = 204;
    response.set("Allow", allowedMethods);
    response.set("Access-Control-Allow-Methods", allowedMethods);
    response.set("Access-Control-Allow-Headers",
                 "Authorization, Range, If-Range, If-Match, If-None-Match, If-Modified-Since, "
                 "If-Unmodified-Since");
    response.set("Access-Control-Max-Age", "7200");
    return response;
}

} // namespace stipple::server
