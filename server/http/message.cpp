#include "server/http/message.hpp"

#include "shared/base/text.hpp"
#include "shared/io/http_date.hpp"

#include <algorithm>

namespace stipple::server {

namespace {
char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}
} // namespace

bool equalIgnoringCase(std::string_view a, std::string_view b) {
    return a.size() == b.size() &&
           std::equal(a.begin(), a.end(), b.begin(), [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
    std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string_view::npos)
        return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

int HttpRequest::count(std::string_view name) const {
    return static_cast<int>(std::count_if(fields.begin(), fields.end(), [&](const auto& field) {
        return equalIgnoringCase(field.first, name);
    }));
}

std::optional<std::string> HttpRequest::field(std::string_view name) const {
    std::optional<std::string> value;
    for (const auto& [fieldName, fieldValue] : fields) {
        if (!equalIgnoringCase(fieldName, name))
            continue;
        if (value)
            value->append(", ").append(fieldValue);
        else
            value = std::string(fieldValue);
    }
    return value;
}

KeptRequest::KeptRequest(const HttpRequest& request) : request_(request) {
    std::size_t size = request.method.size() + request.target.size();
    for (const auto& [name, value] : request.fields)
        size += name.size() + value.size();
    text_.reserve(size); // it must not move
    auto keep = [this](std::string_view& view) {
        std::size_t at = text_.size();
        text_ += view;
        view = std::string_view(text_).substr(at, view.size());
    };
    keep(request_.method);
    keep(request_.target);
    for (auto& [name, value] : request_.fields) {
        keep(name);
        keep(value);
    }
}

void HttpResponse::set(std::string_view name, std::string value) {
    for (auto& [fieldName, fieldValue] : fields)
        if (equalIgnoringCase(fieldName, name)) {
            fieldValue = std::move(value);
            return;
        }
    fields.emplace_back(name, std::move(value));
}

void HttpResponse::addToList(std::string_view name, std::string_view element) {
    std::string list = field(name);
    for (std::string_view rest = list; !rest.empty();) {
        std::size_t comma = std::min(rest.find(','), rest.size());
        if (equalIgnoringCase(trimmed(rest.substr(0, comma)), element))
            return;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    set(name, list.empty() ? std::string(element) : cat(list, ", ", element));
}

std::string HttpResponse::field(std::string_view name) const {
    for (const auto& [fieldName, fieldValue] : fields)
        if (equalIgnoringCase(fieldName, name))
            return fieldValue;
    return {};
}

std::uint64_t HttpResponse::bodyBytes() const {
    std::uint64_t sum = 0;
    for (const BodyPart& part : body) {
        const auto* slice = std::get_if<FileSlice>(&part);
        sum += slice ? slice->size : std::get<std::string>(part).size();
    }
    return sum;
}

const char* reasonPhrase(int status) {
    switch (status) {
    case 200:
        return "OK";
    case 204:
        return "No Content";
    case 206:
        return "Partial Content";
    case 304:
        return "Not Modified";
    case 400:
        return "Bad Request";
    case 401:
        return "Unauthorized";
    case 403:
        return "Forbidden";
    case 404:
        return "Not Found";
    case 405:
        return "Method Not Allowed";
    case 406:
        return "Not Acceptable";
    case 408:
        return "Request Timeout";
    case 410:
        return "Gone";
    case 412:
        return "Precondition Failed";
    case 413:
        return "Content Too Large";
    case 414:
        return "URI Too Long";
    case 416:
        return "Range Not Satisfiable";
    case 417:
        return "Expectation Failed";
    case 429:
        return "Too Many Requests";
    case 431:
        return "Request Header Fields Too Large";
    case 500:
        return "Internal Server Error";
    case 501:
        return "Not Implemented";
    case 502:
        return "Bad Gateway";
    case 503:
        return "Service Unavailable";
    case 504:
        return "Gateway Timeout";
    case 505:
        return "HTTP Version Not Supported";
    default:
        return "";
    }
}

void appendResponseHead(std::string& head, const HttpResponse& response, std::int64_t nowSeconds,
                        bool keepsAlive, BodyFraming framing) {
    auto append = [&head](auto... parts) { (head.append(parts), ...); };
    append("HTTP/1.1 ", std::to_string(response.status), " ", reasonPhrase(response.status),
           "\r\nDate: ", httpDate(nowSeconds), "\r\nServer: stipple\r\n");
    for (const auto& [name, value] : response.fields)
        append(name, ": ", std::string_view(value), "\r\n");
    if (framing == BodyFraming::chunked)
        append("Transfer-Encoding: chunked\r\n");
    else if (framing == BodyFraming::length && response.status != 204 && response.status != 304)
        append("Content-Length: ", std::to_string(response.bodyBytes()), "\r\n");
    append(keepsAlive ? "Connection: keep-alive\r\n\r\n" : "Connection: close\r\n\r\n");
}

} // namespace stipple::server
