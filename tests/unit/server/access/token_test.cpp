#include "server/access/token.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::int64_t now = 1'700'000'000;

struct Made {
    AccessRules rules;
    std::string text;
};

Made withToken(std::int64_t expires = 0) {
    Made made{freshAccessRules().value(), ""};
    auto token = makeToken(made.rules, "Lisa", {"town"}, now, expires);
    REQUIRE(token.ok());
    made.text = token->text;
    made.rules.tokens.push_back(token->rule);
    return made;
}

} // namespace

TEST_CASE("a token is found by its text, and only by all of it") {
    Made made = withToken();
    CHECK(made.text.size() == 60);
    CHECK(made.text.starts_with("stipple_"));
    const TokenRule* found = findToken(made.rules, made.text);
    REQUIRE(found != nullptr);
    CHECK(found->name == "Lisa");
    for (std::size_t i = 0; i < made.text.size(); ++i) {
        std::string other = made.text;
        other[i] = other[i] == 'A' ? 'B' : 'A';
        CHECK(findToken(made.rules, other) == nullptr);
    }
    CHECK(findToken(made.rules, "") == nullptr);
    CHECK(findToken(made.rules, made.text.substr(0, 59)) == nullptr);
    CHECK(findToken(made.rules, made.text + "A") == nullptr);
    CHECK(findToken(AccessRules(), made.text) == nullptr);
}

TEST_CASE("nothing of the secret is in the rules, and two tokens share nothing") {
    Made made = withToken();
    std::string secret = made.text.substr(17);
    CHECK(accessRulesText(made.rules).find(secret) == std::string::npos);
    Made other = withToken();
    CHECK(other.text.substr(8, 8) != made.text.substr(8, 8));
    CHECK(other.rules.tokens[0].salt != made.rules.tokens[0].salt);
    CHECK(findToken(other.rules, made.text) == nullptr);
}

TEST_CASE("a token that expires does so at its second") {
    const Made made = withToken(now + 10);
    CHECK_FALSE(made.rules.tokens[0].isExpired(now + 9));
    CHECK(made.rules.tokens[0].isExpired(now + 10));
    CHECK_FALSE(withToken(0).rules.tokens[0].isExpired(now * 10));
}

TEST_CASE("Authorization brings a token by the scheme Bearer, in any case") {
    for (const char* field :
         {"Bearer abc.DEF-1_~+/==", "bearer abc.DEF-1_~+/==", "BEARER   abc.DEF-1_~+/=="}) {
        Bearer bearer = parseBearer(std::string(field), 1);
        CHECK(bearer.kind == BearerKind::token);
        CHECK(bearer.token == "abc.DEF-1_~+/==");
    }
    CHECK(parseBearer(std::nullopt, 0).kind == BearerKind::none);
    CHECK(parseBearer("Basic dXNlcjpwYXNz", 1).kind == BearerKind::none);
    CHECK(parseBearer("BearerX abc", 1).kind == BearerKind::none);
    CHECK(parseBearer("", 1).kind == BearerKind::none);
    for (const char* field :
         {"Bearer", "Bearer ", "Bearer a b", "Bearer a,b", "Bearer =", "Bearer a=b", "Bearer \"a\""})
        CHECK(parseBearer(std::string(field), 1).kind == BearerKind::malformed);
    CHECK(parseBearer("Bearer a, Bearer b", 2).kind == BearerKind::malformed);
}
