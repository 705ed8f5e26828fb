#include "server/http/target.hpp"

#include "server/http/message.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>

namespace stipple::server {

namespace {

Error refused(std::string what) {
    return {ErrorCode::invalidArgument, std::move(what), "", ""};
}

int hexValue(char c) {
    if (c >= '0' && c <= '9')
        return c - '0';
    if (c >= 'a' && c <= 'f')
        return c - 'a' + 10;
    if (c >= 'A' && c <= 'F')
        return c - 'A' + 10;
    return -1;
}

Result<std::string> decodeSegment(std::string_view text) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char c = text[i];
        if (c == '%') {
            int high = i + 2 < text.size() ? hexValue(text[i + 1]) : -1;
            int low = i + 2 < text.size() ? hexValue(text[i + 2]) : -1;
            if (high < 0 || low < 0)
                return refused("the path has a % that two hexadecimal digits don't follow");
            c = static_cast<char>(high * 16 + low);
            i += 2;
            if (c == '/')
                return refused("the path has an encoded slash");
        }
        auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7F)
            return refused("the path has a control byte");
        if (c == '\\')
            return refused("the path has a backslash");
        decoded += c;
    }
    if (decoded == "." || decoded == "..")
        return refused("the path has a dot segment");
    return decoded;
}

// Drops "http://host" of the absolute form, which every server must accept (RFC 9112 §3.2.2).
Result<std::string_view> originForm(std::string_view target) {
    if (target.starts_with('/'))
        return target;
    for (std::string_view scheme : {std::string_view("http://"), std::string_view("https://")}) {
        if (!equalIgnoringCase(target.substr(0, scheme.size()), scheme))
            continue;
        std::size_t path = target.find_first_of("/?", scheme.size());
        if (path == scheme.size() || target.size() == scheme.size())
            return refused("the address names no host");
        if (path == std::string_view::npos)
            return std::string_view("/");
        if (target[path] == '/')
            return target.substr(path);
    }
    return refused("the target is neither a path nor an http address");
}

} // namespace

std::string Target::relativePath() const {
    std::string path;
    for (const std::string& segment : segments)
        path.append(path.empty() ? "" : "/").append(segment);
    return path;
}

Result<Target> parseTarget(std::string_view target) {
    STIPPLE_TRY(origin, originForm(target));
    std::size_t question = std::min(origin.find('?'), origin.size());
    std::string_view path = origin.substr(0, question);
    Target parsed;
    parsed.query = origin.substr(std::min(question + 1, origin.size()));
    if (path.find('#') != std::string_view::npos)
        return refused("the target has a fragment");

    for (std::string_view rest = path.substr(1); path.size() > 1;) {
        std::size_t slash = std::min(rest.find('/'), rest.size());
        bool isLast = slash == rest.size();
        STIPPLE_TRY(segment, decodeSegment(rest.substr(0, slash)));
        if (segment.empty() && !isLast)
            return refused("the path has an empty segment");
        parsed.segments.push_back(std::move(segment));
        if (isLast)
            break;
        rest.remove_prefix(slash + 1);
    }
    return parsed;
}

std::string percentEncoded(std::string_view segment) {
    std::string encoded;
    for (char c : segment) {
        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '.' || c == '_' || c == '~') {
            encoded += c;
        } else {
            char hex[4];
            std::snprintf(hex, sizeof hex, "%%%02X", static_cast<unsigned char>(c));
            encoded += hex;
        }
    }
    return encoded;
}

} // namespace stipple::server
