#include "server/site/request_rules.hpp"

#include "server/http/problem.hpp"

namespace stipple::server {

namespace {

HttpResponse refusal(int status, const char* detail) {
    HttpResponse response = problemResponse(status, detail);
    response.closes = true;
    return response;
}

} // namespace

std::optional<HttpResponse> checkRequestRules(const HttpRequest& request) {
    if (request.version != 10 && request.version != 11)
        return refusal(505, "only HTTP/1.0 and HTTP/1.1 are spoken here");
    if (auto coding = request.field("Transfer-Encoding"))
        return equalIgnoringCase(*coding, "chunked") && request.version == 11
                   ? refusal(413, "requests with a body are not accepted")
                   : refusal(501, "the transfer coding is not known");
    if (request.count("Content-Length") > 1)
        return refusal(400, "there is more than one Content-Length");
    if (auto length = request.field("Content-Length"); length && *length != "0")
        return refusal(413, "requests with a body are not accepted");
    int hosts = request.count("Host");
    if (hosts > 1 || (hosts == 0 && request.version == 11))
        return refusal(400, "there must be one Host field");
    if (hosts == 1 && request.field("Host")->find_first_of(" \t,/\\@?#") != std::string::npos)
        return refusal(400, "the Host field is malformed");
    if (auto expect = request.field("Expect"); expect && !equalIgnoringCase(*expect, "100-continue"))
        return refusal(417, "the expectation is not known");
    return std::nullopt;
}

} // namespace stipple::server
