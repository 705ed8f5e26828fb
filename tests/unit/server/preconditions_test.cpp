#include "server/http/preconditions.hpp"

#include "shared/io/http_date.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::int64_t changedAt = 1'600'000'000, now = 1'700'000'000;
const Validators file{"\"v2\"", changedAt};
const std::string before = httpDate(changedAt - 1), at = httpDate(changedAt), after = httpDate(changedAt + 1);

using Fields = std::vector<std::pair<std::string_view, std::string_view>>;

Precondition evaluate(Fields fields) {
    return evaluatePreconditions({"GET", "/", 11, std::move(fields)}, file, now);
}
bool applies(Fields fields, std::int64_t clock = now) {
    return rangeApplies({"GET", "/", 11, std::move(fields)}, file, clock);
}

} // namespace

TEST_CASE("a request without conditions passes") {
    CHECK(evaluate({}) == Precondition::passed);
}

TEST_CASE("If-Match needs this version by a strong tag") {
    CHECK(evaluate({{"If-Match", "\"v2\""}}) == Precondition::passed);
    CHECK(evaluate({{"If-Match", "\"v1\", \"v2\""}}) == Precondition::passed);
    CHECK(evaluate({{"If-Match", "\"v1\""}, {"if-match", "\"v2\""}}) == Precondition::passed);
    CHECK(evaluate({{"If-Match", "*"}}) == Precondition::passed);
    CHECK(evaluate({{"If-Match", "\"v1\""}}) == Precondition::failed);
    CHECK(evaluate({{"If-Match", "W/\"v2\""}}) == Precondition::failed);
    CHECK(evaluate({{"If-Match", "v2"}}) == Precondition::failed);
}

TEST_CASE("If-Unmodified-Since counts only without If-Match") {
    CHECK(evaluate({{"If-Unmodified-Since", before}}) == Precondition::failed);
    CHECK(evaluate({{"If-Unmodified-Since", at}}) == Precondition::passed);
    CHECK(evaluate({{"If-Unmodified-Since", "yesterday"}}) == Precondition::passed);
    CHECK(evaluate({{"If-Match", "\"v2\""}, {"If-Unmodified-Since", before}}) == Precondition::passed);
}

TEST_CASE("If-None-Match finds this version, weakly") {
    CHECK(evaluate({{"If-None-Match", "\"v2\""}}) == Precondition::notModified);
    CHECK(evaluate({{"If-None-Match", "\"v1\", W/\"v2\""}}) == Precondition::notModified);
    CHECK(evaluate({{"If-None-Match", "*"}}) == Precondition::notModified);
    CHECK(evaluate({{"If-None-Match", "\"v1\""}}) == Precondition::passed);
    CHECK(evaluate({{"If-None-Match", "v2"}}) == Precondition::passed);
}

TEST_CASE("If-Modified-Since counts only without If-None-Match") {
    CHECK(evaluate({{"If-Modified-Since", before}}) == Precondition::passed);
    CHECK(evaluate({{"If-Modified-Since", at}}) == Precondition::notModified);
    CHECK(evaluate({{"If-Modified-Since", after}}) == Precondition::notModified);
    CHECK(evaluate({{"If-None-Match", "\"v1\""}, {"If-Modified-Since", after}}) == Precondition::passed);
}

TEST_CASE("a failed If-Match comes before a matching If-None-Match") {
    CHECK(evaluate({{"If-None-Match", "\"v2\""}, {"If-Match", "\"v1\""}}) == Precondition::failed);
}

TEST_CASE("If-Range lets the range count for exactly this version") {
    CHECK(applies({}));
    CHECK(applies({{"If-Range", "\"v2\""}}));
    CHECK(applies({{"If-Range", at}}));
    CHECK_FALSE(applies({{"If-Range", "\"v1\""}}));
    CHECK_FALSE(applies({{"If-Range", "W/\"v2\""}}));
    CHECK_FALSE(applies({{"If-Range", after}}));
    CHECK_FALSE(applies({{"If-Range", before}}));
    CHECK_FALSE(applies({{"If-Range", "nonsense"}}));
    CHECK_FALSE(applies({{"If-Range", "\"v2\", \"v1\""}}));
    CHECK_FALSE(applies({{"If-Range", at}}, changedAt)); // may change again within this second
}
