#include "server/http/request_header.hpp"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/http/basic_parser.hpp>
#include <limits>

namespace stipple::server {

namespace {

namespace http = boost::beast::http;
using Failure = boost::beast::error_code;

// A method is a token (RFC 9110 §5.6.2); ours begin with a letter, so a TLS hello is told at its first byte.
bool canBeginRequest(char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '\r';
}

std::string_view view(boost::beast::string_view text) {
    return {text.data(), text.size()};
}

// "HTTP/2.0" and the like at the end of the request line: not nonsense, but not spoken here.
bool namesOtherVersion(std::string_view header) {
    std::string_view line = header.substr(0, header.find('\r'));
    constexpr std::size_t length = std::string_view("HTTP/1.1").size();
    if (line.size() < length)
        return false;
    std::string_view version = line.substr(line.size() - length);
    auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    return version.starts_with("HTTP/") && isDigit(version[5]) && version[6] == '.' && isDigit(version[7]) &&
           version != "HTTP/1.0" && version != "HTTP/1.1";
}

class HeaderParser final : public http::basic_parser<true> {
  public:
    explicit HeaderParser(HttpRequest& request) : request_(request) {
        header_limit(std::numeric_limits<std::uint32_t>::max()); // whoever scanned it has limited it
        body_limit(boost::none);
    }

  private:
    void on_request_impl(http::verb, boost::beast::string_view method, boost::beast::string_view target,
                         int version, Failure&) override {
        request_.method = view(method);
        request_.target = view(target);
        request_.version = version;
    }
    void on_field_impl(http::field, boost::beast::string_view name, boost::beast::string_view value,
                       Failure&) override {
        request_.fields.emplace_back(view(name), view(value));
    }
    void on_response_impl(int, boost::beast::string_view, int, Failure&) override {}
    void on_header_impl(Failure&) override {}
    void on_body_init_impl(const boost::optional<std::uint64_t>&, Failure&) override {}
    std::size_t on_body_impl(boost::beast::string_view, Failure&) override { return 0; }
    void on_chunk_header_impl(std::uint64_t, boost::beast::string_view, Failure&) override {}
    std::size_t on_chunk_body_impl(std::uint64_t, boost::beast::string_view, Failure&) override { return 0; }
    void on_finish_impl(Failure&) override {}

    HttpRequest& request_;
};

} // namespace

HeaderScan::State HeaderScan::scan(std::string_view bytes) {
    for (;;) {
        if (lines_ == 0 && lineBegin_ < bytes.size() && !canBeginRequest(bytes[lineBegin_]))
            return State::malformed;
        std::size_t feed = bytes.find('\n', looked_);
        if (feed == std::string_view::npos) {
            looked_ = bytes.size();
            return State::needsMore;
        }
        if (feed == lineBegin_ || bytes[feed - 1] != '\r')
            return State::malformed;
        bool isEmpty = feed == lineBegin_ + 1;
        bool isFolded = bytes[lineBegin_] == ' ' || bytes[lineBegin_] == '\t';
        if (isFolded)
            return State::malformed;
        lineBegin_ = looked_ = feed + 1;
        if (!isEmpty) {
            ++lines_;
        } else if (lines_ > 0) {
            end_ = feed + 1;
            return State::complete;
        } else {
            begin_ = feed + 1; // an empty line before the request
        }
    }
}

int parseRequestHeader(std::string_view header, HttpRequest& request) {
    request.fields.clear();
    request.method = request.target = {};
    HeaderParser parser(request);
    Failure error;
    parser.put(boost::asio::const_buffer(header.data(), header.size()), error);
    if (!error && !parser.is_header_done())
        error = http::error::need_more; // a header that was scanned is complete
    if (!error)
        return 0;
    request.fields.clear();
    return error == http::error::bad_version && namesOtherVersion(header) ? 505 : 400;
}

bool wantsKeepAlive(const HttpRequest& request) {
    if (request.version != 11)
        return false;
    for (const auto& [name, value] : request.fields) {
        if (!equalIgnoringCase(name, "Connection"))
            continue;
        for (std::string_view rest = value; !rest.empty();) {
            std::size_t comma = std::min(rest.find(','), rest.size());
            if (equalIgnoringCase(trimmed(rest.substr(0, comma)), "close"))
                return false;
            rest.remove_prefix(std::min(comma + 1, rest.size()));
        }
    }
    return true;
}

} // namespace stipple::server
