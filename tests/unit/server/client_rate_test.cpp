#include "server/http/client_rate.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;
using namespace std::chrono_literals;

TEST_CASE("a client has its turns at once, then one after the other") {
    ClientRate rate(6); // every ten seconds
    ClientRate::Clock::time_point now{};
    for (int i = 0; i < 6; ++i)
        CHECK(rate.take("a", now) == 0s);
    CHECK(rate.take("a", now) == 10s);
    CHECK(rate.take("a", now + 4s) == 6s);
    CHECK(rate.take("a", now + 9500ms) == 1s);
    CHECK(rate.take("b", now) == 0s); // another one's affair
    CHECK(rate.take("a", now + 10s) == 0s);
    CHECK(rate.take("a", now + 10s) == 10s);
    for (int i = 0; i < 6; ++i)
        CHECK(rate.take("a", now + 1h) == 0s); // no more than a minute's worth is saved
    CHECK(rate.take("a", now + 1h) == 10s);
}

TEST_CASE("less than one a minute is one, now and then") {
    ClientRate rate(0.5);
    ClientRate::Clock::time_point now{};
    CHECK(rate.take("a", now) == 0s);
    CHECK(rate.take("a", now + 1min) == 60s);
    CHECK(rate.take("a", now + 2min) == 0s);
}

TEST_CASE("no limit takes note of nobody") {
    ClientRate::Clock::time_point now{};
    ClientRate any(0);
    for (int i = 0; i < 1000; ++i)
        CHECK(any.take("a", now) == 0s);
    CHECK(any.clients() == 0);
}

TEST_CASE("clients that have all their turns again are forgotten when there are many") {
    ClientRate rate(60);
    ClientRate::Clock::time_point now{};
    for (std::size_t i = 0; i < ClientRate::maxClients; ++i)
        rate.take(std::to_string(i), now);
    CHECK(rate.clients() == ClientRate::maxClients);
    CHECK(rate.take("late", now) == 0s);
    CHECK(rate.take("later", now) == 0s);
    CHECK(rate.clients() == ClientRate::maxClients + 1); // these two share one
    CHECK(rate.take("after a minute", now + 60s) == 0s);
    CHECK(rate.clients() <= 2);
}
