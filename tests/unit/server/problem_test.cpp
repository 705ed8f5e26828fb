#include "server/http/problem.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

using namespace stipple;
using namespace stipple::server;

namespace {

nlohmann::json documentOf(const HttpResponse& response) {
    REQUIRE(response.body.size() == 1);
    return nlohmann::json::parse(std::get<std::string>(response.body.front()), nullptr, false);
}

} // namespace

TEST_CASE("a problem document says type, title, status, detail, instance and parameter") {
    auto response = problemResponse({problem_types::invalidParameter, "strata is 1 to 4", "strata"});
    setProblemInstance(response, "/api/v1/clouds/town/nodes/0-0-0-0?strata=9&token=secret");
    CHECK(response.status == 400);
    CHECK(response.field("Content-Type") == "application/problem+json");
    CHECK(response.field("Cache-Control") == "no-store");
    CHECK(documentOf(response) == nlohmann::json{{"type", "/api/v1/problems/invalid-parameter"},
                                                 {"title", "Invalid parameter"},
                                                 {"status", 400},
                                                 {"detail", "strata is 1 to 4"},
                                                 {"instance", "/api/v1/clouds/town/nodes/0-0-0-0"},
                                                 {"parameter", "strata"}});
}

TEST_CASE("bytes that are no UTF-8 don't break a problem document") {
    auto response = problemResponse(400, "\xFF\xFE");
    setProblemInstance(response, "/\xFF");
    CHECK(documentOf(response)["detail"].is_string());
    CHECK(documentOf(response)["instance"].is_string());
}

TEST_CASE("other responses get no instance") {
    HttpResponse response;
    response.set("Content-Type", "application/json");
    response.body.push_back("{}");
    setProblemInstance(response, "/a");
    CHECK(std::get<std::string>(response.body.front()) == "{}");
}

TEST_CASE("each status that is answered has a type, and no two types share a name") {
    std::set<std::string> names;
    for (const ProblemType& type : problemTypes()) {
        CHECK(names.insert(type.name).second);
        CHECK(std::string(reasonPhrase(type.status)) != "");
        CHECK(problemResponse({type, "x"}).status == type.status);
    }
    for (int status : {400, 401, 403, 404, 405, 408, 412, 413, 414, 416, 417, 431, 500, 501, 503, 505})
        CHECK(problemResponse(status, "x").status == status);
}

TEST_CASE("errors of work become the status that says whose fault it was") {
    auto statusOf = [](ErrorCode code) {
        return jobProblem({code, "what", "/secret/path/town.stipple", ""}).status;
    };
    CHECK(statusOf(ErrorCode::notFound) == 404);
    CHECK(statusOf(ErrorCode::invalidArgument) == 400);
    CHECK(statusOf(ErrorCode::limitExceeded) == 400);
    CHECK(statusOf(ErrorCode::cancelled) == 503);
    CHECK(statusOf(ErrorCode::changed) == 503);
    CHECK(statusOf(ErrorCode::corrupt) == 503);
    CHECK(statusOf(ErrorCode::networkFailed) == 502);
    CHECK(statusOf(ErrorCode::ioFailed) == 500);
    for (int code = 0; code <= static_cast<int>(ErrorCode::cancelled); ++code) {
        auto response = jobProblem({static_cast<ErrorCode>(code), "what", "/secret/path/town.stipple", ""});
        CHECK(std::get<std::string>(response.body.front()).find("/secret") == std::string::npos);
    }
}
