#include "server/api/query.hpp"
#include "server/http/problem.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

// Of a query that parses.
Query query(std::string_view text) {
    auto parsed = Query::parse(text);
    if (!parsed)
        FAIL(parsed.error().sentence());
    return *std::move(parsed);
}

// "parameter: sentence without it" of a refusal.
template <class T>
std::string refusal(const T& result) {
    REQUIRE_FALSE(result.ok());
    CHECK(result.error().code == ErrorCode::invalidArgument);
    return result.error().sentence();
}

} // namespace

TEST_CASE("parameters are decoded once") {
    Query q = query("a=1&GPS%20Time=x%2By&c=%2541&d=1+2&e=a=b&f=%C3%A4&g=%0A");
    CHECK(*q.find("a") == "1");
    CHECK(*q.find("GPS Time") == "x+y");
    CHECK(*q.find("c") == "%41");
    CHECK(*q.find("d") == "1 2");
    CHECK(*q.find("e") == "a=b");
    CHECK(*q.find("f") == "ä");
    CHECK(*q.find("g") == "\n");
    CHECK(q.find("A") == nullptr);
    CHECK_FALSE(query("").has(""));
}

TEST_CASE("queries that could be read in two ways are refused") {
    CHECK(refusal(Query::parse("a=1&b=2&a=1")) == "a: it is given twice (give it once)");
    CHECK(refusal(Query::parse("a=1&%61=2")) == "a: it is given twice (give it once)");
    CHECK(refusal(Query::parse("a")) == "a: it has no value (write name=value)");
    CHECK(refusal(Query::parse("a=")) == "a: it has no value (write name=value)");
    for (const char* text : {"&",           "a=1&",        "&a=1",           "a=1&&b=2",       "=1",
                             "%3D=%",       "a=%",         "a=%4",           "a=%4g",          "a=%-1",
                             "%=1",         "a=%00",       "a=%01",          "a=%7f",          "a=%1b",
                             "a=\x01",      "a=%80",       "a=%C3",          "a=%C3%28",       "a=%C0%AF",
                             "a=%E0%80%AF", "a=%ED%A0%80", "a=%F0%80%80%80", "a=%F4%90%80%80", "a=%F8",
                             "a=%FF",       "%FF=1",       "%00=1"}) {
        INFO(text);
        auto parsed = Query::parse(text);
        REQUIRE_FALSE(parsed.ok());
        CHECK(parsed.error().code == ErrorCode::invalidArgument);
    }
}

TEST_CASE("a query has a limited number of parameters") {
    std::string text;
    for (std::size_t i = 0; i < maxQueryParameters; ++i)
        text += (i > 0 ? "&p" : "p") + std::to_string(i) + "=1";
    CHECK(query(text).has("p0"));
    CHECK_FALSE(Query::parse(text + "&q=1").ok());
}

TEST_CASE("parameters nobody knows are refused with those there are") {
    Query q = query("box=1&bocks=2");
    CHECK(q.allowOnly({"box", "bocks", "limit"}).ok());
    CHECK(refusal(q.allowOnly({"box", "limit"})) ==
          "bocks: there is no such parameter here (there are box, limit)");
    CHECK(refusal(q.allowOnly({})) == "box: there is no such parameter here (this address takes none)");
}

TEST_CASE("numbers are finite, whole texts and in their range") {
    Query q = query("a=-1.5e3&b=nan&c=inf&d=1e999&e=0x10&f=1%20&g=%2B1&h=1e&i=.5&j=--1&k=1,2");
    CHECK(**q.number("a") == -1500);
    CHECK(**q.number("i") == 0.5);
    CHECK_FALSE(q.number("z")->has_value());
    for (const char* name : {"b", "c", "d", "e", "f", "g", "h", "j", "k"}) {
        INFO(name);
        CHECK_FALSE(q.number(name).ok());
    }
    CHECK(refusal(q.number("b")) == "b: \"nan\" is no finite number (give a finite number)");
    CHECK(refusal(q.number("a", 0)) == "a: \"-1.5e3\" is out of range (give a number, at least 0)");
    CHECK(refusal(q.number("i", 1, 2)) == "i: \".5\" is out of range (give a number from 1 to 2)");
}

TEST_CASE("counts are digits and in their range") {
    Query q = query("a=18446744073709551615&b=18446744073709551616&c=-1&d=1.0&e=%201&f=007&g=1e3");
    CHECK(**q.count("a") == 18446744073709551615u);
    CHECK(**q.count("f") == 7);
    CHECK(refusal(q.count("b", 0, 9)) ==
          "b: \"18446744073709551616\" is out of range (give a whole number from 0 to 9)");
    CHECK(refusal(q.count("f", 8, 9)) == "f: \"007\" is out of range (give a whole number from 8 to 9)");
    for (const char* name : {"c", "d", "e", "g"}) {
        INFO(name);
        CHECK_FALSE(q.count(name).ok());
    }
    CHECK(refusal(q.count("c", 0, 9)) == "c: \"-1\" is no whole number (give a whole number from 0 to 9)");
}

TEST_CASE("lists of numbers have one of the lengths that a form shows") {
    Query q = query("a=1,2,-3&b=1,2&c=1,2,&d=1,2,x");
    CHECK(**q.numbers("a", "x,y,z") == std::vector<double>{1, 2, -3});
    CHECK(**q.numbers("a", "x,y|x,y,z") == std::vector<double>{1, 2, -3});
    CHECK(**q.numbers("b", "x,y|x,y,z") == std::vector<double>{1, 2});
    CHECK_FALSE(q.numbers("z", "x,y,z")->has_value());
    CHECK(refusal(q.numbers("b", "x,y,z|x")) == "b: it has 2 numbers (give x,y,z or x)");
    CHECK(refusal(q.numbers("c", "x,y,z")) == "c: \"\" is no finite number (give x,y,z)");
    CHECK(refusal(q.numbers("d", "x,y,z")) == "d: \"x\" is no finite number (give x,y,z)");
}

TEST_CASE("choices are taken as written") {
    Query q = query("format=las&other=LAS");
    CHECK(**q.choice("format", {"csv", "las"}) == 1);
    CHECK_FALSE(q.choice("z", {"a"})->has_value());
    CHECK(refusal(q.choice("other", {"csv", "las"})) ==
          "other: \"LAS\" is not known (choose one of csv, las)");
}

TEST_CASE("messages cut long values between characters") {
    CHECK(quotedValue("a") == "\"a\"");
    CHECK(quotedValue(std::string(60, 'a')) == "\"" + std::string(60, 'a') + "\"");
    CHECK(quotedValue(std::string(59, 'a') + "äb") == "\"" + std::string(59, 'a') + "…\"");
    CHECK(quotedValue(std::string(61, 'a')) == "\"" + std::string(60, 'a') + "…\"");
}

TEST_CASE("a refused parameter is a problem document that names it") {
    HttpResponse response = parameterProblem(Query::parse("box=1&box=2").error());
    CHECK(response.status == 400);
    CHECK(response.field("Content-Type") == "application/problem+json");
    auto document = nlohmann::json::parse(std::get<std::string>(response.body.at(0)));
    CHECK(document == nlohmann::json{{"type", "/api/v1/problems/invalid-parameter"},
                                     {"title", "Invalid parameter"},
                                     {"status", 400},
                                     {"detail", "box: it is given twice (give it once)"},
                                     {"parameter", "box"}});
    document =
        nlohmann::json::parse(std::get<std::string>(parameterProblem(Query::parse("&").error()).body.at(0)));
    CHECK_FALSE(document.contains("parameter"));
}
