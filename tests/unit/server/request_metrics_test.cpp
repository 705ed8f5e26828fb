#include "server/net/request_metrics.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;

TEST_CASE("routes and clouds are told by the target") {
    CHECK(routeOf("/clouds/a.stipple") == Route::cloudFile);
    CHECK(routeOf("/api/v1/clouds") == Route::api);
    CHECK(routeOf("/metrics?x") == Route::operations);
    CHECK(routeOf("/metricsx") == Route::page);
    CHECK(routeOf("/") == Route::page);
    CHECK(routeOf("") == Route::invalid);
    CHECK(cloudOf("/clouds/a-b_c.1.stipple?token=x") == "a-b_c.1");
    CHECK(cloudOf("/api/v1/clouds/a") == "a");
    CHECK(cloudOf("/api/v1/clouds/a/nodes/0-0-0-0?x=/y") == "a");
    for (const char* target :
         {"/clouds/", "/clouds/.stipplex", "/clouds/a", "/clouds/.stipple", "/api/v1/clouds",
          "/api/v1/clouds/", "/api/v1/clouds/a%2fb", "/clouds/a\"b.stipple", "/x"})
        CHECK_FALSE(cloudOf(target).has_value());
}

TEST_CASE("requests are counted by route, status, time and cloud") {
    RequestMetrics metrics;
    metrics.began();
    metrics.began();
    CHECK(metrics.totals().inFlight == 2);
    metrics.ended({"/clouds/a.stipple", 206, 100, 0.0005, true});
    metrics.ended({"/clouds/a.stipple", 206, 50, 99, false});
    RequestTotals totals = metrics.totals();
    const auto& route = totals.routes[static_cast<std::size_t>(Route::cloudFile)];
    CHECK(route.byStatusClass[2] == 2);
    CHECK(route.bodyBytes == 150);
    CHECK(route.bySeconds.front() == 1); // a bound belongs to what is below it
    CHECK(route.bySeconds.back() == 1);
    CHECK(totals.cut == 1);
    CHECK(totals.inFlight == 0);
    CHECK(totals.clouds.at("a").requests == 2);
    totals.add(totals);
    CHECK(totals.clouds.at("a").bodyBytes == 300);
    CHECK(totals.routes[static_cast<std::size_t>(Route::cloudFile)].count == 4);
}

TEST_CASE("clients can't make the numbers of clouds grow without end") {
    RequestMetrics metrics;
    for (int i = 0; i < 1000; ++i)
        metrics.ended({"/clouds/none" + std::to_string(i) + ".stipple", 404, 0, 0, true});
    CHECK(metrics.totals().clouds.empty());
    for (int i = 0; i < 1000; ++i)
        metrics.ended({"/clouds/c" + std::to_string(i) + ".stipple", 200, 1, 0, true});
    RequestTotals totals = metrics.totals();
    CHECK(totals.clouds.size() == RequestTotals::maxClouds + 1);
    CHECK(totals.clouds.at(RequestTotals::otherClouds).requests == 1000 - RequestTotals::maxClouds);
}
