#include "server/api/api.hpp"
#include "server/http/problem.hpp"
#include "tests/unit/server/api/api_fixture.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;
using namespace stipple::test;

TEST_CASE("paths of the API are those below /api/v1") {
    for (auto target : {"/api/v1/clouds", "/api/v1/x", "/api/v1/"})
        CHECK(isApiPath(*parseTarget(target)));
    for (auto target : {"/", "/api", "/api/v1", "/api/v2/clouds", "/clouds/api/v1", "/x/api/v1/clouds"})
        CHECK_FALSE(isApiPath(*parseTarget(target)));
}

TEST_CASE("each path leads to its endpoint") {
    ApiFixture api;
    CHECK(api.ask("/api/v1/clouds").json["clouds"][0]["id"] == "small");
    CHECK(api.ask("/api/v1/clouds/small").json["id"] == "small");
    CHECK(api.ask("/api/v1/problems/no-such-node").json["status"] == 404);
}

TEST_CASE("paths that lead nowhere are 404") {
    ApiFixture api;
    for (auto target : {"/api/v1/", "/api/v1/cloud", "/api/v1/clouds/", "/api/v1/clouds/small/",
                        "/api/v1/clouds/small/x", "/api/v1/clouds/small/nodes/0-0-0-0/x",
                        "/api/v1/problems/x", "/api/v1/problems", "/api/v1/%7Bid%7D"}) {
        INFO(target);
        CHECK(api.ask(target).status == 404);
    }
}

TEST_CASE("a cloud that there is not is told from a path that there is not") {
    ApiFixture api;
    CHECK(api.ask("/api/v1/clouds/other").json["type"] == "/api/v1/problems/no-such-cloud");
    CHECK(api.ask("/api/v1/other").json["type"] == "/api/v1/problems/not-found");
}

TEST_CASE("every problem's type can be opened") {
    ApiFixture api;
    for (const ProblemType& type : problemTypes()) {
        auto answer = api.ask(problemAddress(type));
        CHECK(answer.status == 200);
        CHECK(answer.json["type"] == problemAddress(type));
    }
}

TEST_CASE("parameters that an endpoint does not have are refused by name") {
    ApiFixture api;
    auto answer = api.ask("/api/v1/clouds/small?strata=1");
    CHECK(answer.status == 400);
    CHECK(answer.json["type"] == "/api/v1/problems/unknown-parameter");
    CHECK(answer.json["parameter"] == "strata");
    CHECK(api.ask("/api/v1/clouds/small?%FF").json["type"] == "/api/v1/problems/invalid-parameter");
}
