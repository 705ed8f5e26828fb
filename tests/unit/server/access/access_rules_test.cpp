#include "server/access/access_rules.hpp"

#include "server/access/token.hpp"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

using namespace stipple;
using namespace stipple::server;
using Json = nlohmann::ordered_json;

namespace {

AccessRules someRules() {
    AccessRules rules = freshAccessRules().value();
    rules.privateClouds = {"survey-*", "plant"};
    rules.publicClouds = {"survey-demo"};
    for (const char* name : {"Lisa", "Bürö \"x\""})
        rules.tokens.push_back(
            makeToken(rules, name, {"survey-2024", "p*"}, 1'700'000'000, 1'800'000'000)->rule);
    return rules;
}

ErrorCode codeOf(const Json& json) {
    auto rules = parseAccessRules(json.dump());
    return rules ? ErrorCode::notFound : rules.error().code;
}

} // namespace

TEST_CASE("rules come back from their text as they were") {
    AccessRules rules = someRules();
    auto again = parseAccessRules(accessRulesText(rules));
    REQUIRE(again.ok());
    CHECK(accessRulesText(*again) == accessRulesText(rules));
    CHECK(again->signingKey == rules.signingKey);
    REQUIRE(again->tokens.size() == 2);
    CHECK(again->tokens[1].hash == rules.tokens[1].hash);
    CHECK(again->tokens[1].expiresSeconds == 1'800'000'000);
}

TEST_CASE("a cloud is private by pattern, unless it is an exception") {
    AccessRules rules = someRules();
    CHECK(rules.isPrivate("survey-2024"));
    CHECK(rules.isPrivate("plant"));
    CHECK_FALSE(rules.isPrivate("survey-demo"));
    CHECK_FALSE(rules.isPrivate("town"));
    CHECK(rules.hidesAny());
    CHECK_FALSE(AccessRules().hidesAny());
}

TEST_CASE("a file may leave out its lists, but not its key or version") {
    Json json = Json::parse(accessRulesText(freshAccessRules().value()));
    for (const char* list : {"private", "public", "tokens"})
        json.erase(list);
    CHECK(parseAccessRules(json.dump()).ok());
    Json without = json;
    without.erase("signingKey");
    CHECK(codeOf(without) == ErrorCode::corrupt);
    json["version"] = 2;
    CHECK(codeOf(json) == ErrorCode::unsupported);
    json.erase("version");
    CHECK(codeOf(json) == ErrorCode::unsupported);
}

TEST_CASE("a damaged member is named, and nothing of the file is used") {
    const Json good = Json::parse(accessRulesText(someRules()));
    auto damaged = [&](const char* path, const Json& value) {
        Json json = good;
        json[Json::json_pointer(path)] = value;
        INFO(path << " " << value);
        CHECK(codeOf(json) == ErrorCode::corrupt);
    };
    for (const char* path : {"/private", "/public", "/tokens"})
        for (const Json& value : {Json("town"), Json(3), Json::object(), Json(nullptr), Json::array({3})})
            damaged(path, value);
    for (const char* path : {"/private/0", "/tokens/0/clouds/0"})
        for (const Json& value : {Json(""), Json("a b"), Json("../x"), Json(1)})
            damaged(path, value);
    for (const char* path : {"/signingKey", "/tokens/0/salt", "/tokens/0/hash", "/tokens/0/id"})
        for (const Json& value : {Json(""), Json("AAAA"), Json(std::string(43, '!')), Json(1), Json(nullptr)})
            damaged(path, value);
    for (const char* path : {"/tokens/0/created", "/tokens/0/expires"})
        for (const Json& value : {Json(-1), Json(1.5), Json("1"), Json(18446744073709551615ull)})
            damaged(path, value);
    damaged("/tokens/0/name", 3);
    damaged("/tokens/1/id", good["tokens"][0]["id"]);
    for (const char* text : {"", "[]", "3", "{", "null"})
        CHECK(parseAccessRules(text).error().code == ErrorCode::corrupt);
}

TEST_CASE("every truncation of an access file is refused") {
    std::string text = accessRulesText(someRules());
    for (std::size_t size = 0; size + 2 < text.size(); ++size) // the last two: "}\n"
        CHECK_FALSE(parseAccessRules(text.substr(0, size)).ok());
}
