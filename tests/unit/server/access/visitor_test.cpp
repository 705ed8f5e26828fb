#include "server/access/visitor.hpp"

#include "server/access/token.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::int64_t now = 1'700'000'000;

// Clouds: plant and survey-1 are private, town is public. Lisa's token is for plant, Tom's for everything,
// the old one has expired.
struct Scene {
    std::shared_ptr<AccessRules> rules = std::make_shared<AccessRules>(freshAccessRules().value());
    std::string lisa = add("Lisa", {"plant"}, 0), tom = add("Tom", {"*"}, now + 1),
                old = add("old", {"*"}, now);
    Scene() { rules->privateClouds = {"plant", "survey-*"}; }

    std::string add(const char* name, std::vector<std::string> clouds, std::int64_t expires) {
        auto token = makeToken(*rules, name, std::move(clouds), now - 100, expires);
        rules->tokens.push_back(token->rule);
        return "Bearer " + token->text;
    }
    Visitor visitor(const std::string& authorization, const std::string& query = "") const {
        HttpRequest request{"GET", "/", 11, {}};
        if (!authorization.empty())
            request.fields.emplace_back("authorization", authorization);
        return Visitor(rules, request, query, now);
    }
    std::string signedFor(const char* id, std::int64_t expires = now + 1) const {
        return signedQuery(rules->signingKey, id, expires);
    }
};

// Status and challenge; "may" where there is no refusal.
std::string outcome(const std::optional<HttpResponse>& refusal) {
    if (!refusal)
        return "may";
    std::string challenge = refusal->field("WWW-Authenticate");
    std::size_t error = challenge.find("error=\"");
    REQUIRE(challenge.starts_with("Bearer realm=\"stipple\""));
    CHECK(refusal->field("Cache-Control") == "no-store");
    return std::to_string(refusal->status) +
           (error == std::string::npos
                ? ""
                : " " + challenge.substr(error + 7, challenge.find('"', error + 7) - error - 7));
}

std::string bodyOf(const std::optional<HttpResponse>& response) {
    return response ? std::get<std::string>(response->body.front()) : "";
}

} // namespace

TEST_CASE("a public cloud is for everybody, whatever they bring") {
    Scene scene;
    for (const std::string& credentials :
         {std::string(), scene.lisa, scene.old, std::string("Bearer x"), std::string("Bearer")})
        CHECK(outcome(scene.visitor(credentials).refusal("town", true)) == "may");
    CHECK(outcome(scene.visitor("", "expires=1&signature=x").refusal("town", true)) == "may");
    CHECK_FALSE(scene.visitor("").isRestricted("town"));
    CHECK(scene.visitor("").isRestricted("plant"));
}

TEST_CASE("a private cloud needs a token for it") {
    Scene scene;
    auto plant = [&](const std::string& credentials) {
        return outcome(scene.visitor(credentials).refusal("plant", true));
    };
    CHECK(plant("") == "401");
    CHECK(plant("Basic dXNlcjpwYXNz") == "401");
    CHECK(plant(scene.lisa) == "may");
    CHECK(plant(scene.tom) == "may");
    CHECK(plant(scene.old) == "401 invalid_token");
    CHECK(plant("Bearer nonsense") == "401 invalid_token");
    CHECK(plant("Bearer a b") == "400 invalid_request");
    CHECK(outcome(scene.visitor(scene.lisa).refusal("survey-1", true)) == "403 insufficient_scope");
    CHECK(scene.visitor(scene.lisa).name() == "Lisa");
    CHECK(scene.visitor(scene.old).name().empty());
}

TEST_CASE("a signed address opens its cloud, also beside a token for another") {
    Scene scene;
    CHECK(outcome(scene.visitor("", scene.signedFor("plant")).refusal("plant", true)) == "may");
    CHECK(outcome(scene.visitor("", scene.signedFor("plant")).refusal("survey-1", true)) ==
          "401 invalid_token");
    CHECK(outcome(scene.visitor("", scene.signedFor("plant", now)).refusal("plant", true)) ==
          "401 invalid_token");
    CHECK(outcome(scene.visitor(scene.lisa, scene.signedFor("survey-1")).refusal("survey-1", true)) == "may");
    CHECK(outcome(scene.visitor(scene.old, scene.signedFor("survey-1")).refusal("survey-1", true)) == "may");
}

TEST_CASE("who may not read a cloud can't tell whether there is one") {
    Scene scene;
    for (const std::string& credentials :
         {std::string(), scene.lisa, scene.old, std::string("Bearer x"), std::string("Bearer")})
        for (const std::string& query : {std::string(), std::string("expires=1"), scene.signedFor("other")}) {
            INFO(credentials << " " << query);
            Visitor visitor = scene.visitor(credentials, query);
            auto there = visitor.refusal("survey-1", true), gone = visitor.refusal("survey-1", false),
                 never = visitor.refusal("nothing", false);
            CHECK(outcome(there) != "may");
            for (const auto& absent : {gone, never}) {
                CHECK(outcome(absent) == outcome(there));
                CHECK(bodyOf(absent) == bodyOf(there));
                CHECK(absent->fields == there->fields);
            }
        }
}

TEST_CASE("who may read a cloud may know that it is gone") {
    Scene scene;
    CHECK(outcome(scene.visitor(scene.lisa).refusal("plant", false)) == "may");
    CHECK(outcome(scene.visitor(scene.tom).refusal("nothing", false)) == "may");
    CHECK(outcome(scene.visitor("", scene.signedFor("nothing")).refusal("nothing", false)) == "may");
}

TEST_CASE("a list shows what its reader may read, and is refused to bad credentials") {
    Scene scene;
    auto seen = [&](const Visitor& visitor) {
        std::string ids;
        for (const char* id : {"plant", "survey-1", "town"})
            if (visitor.mayRead(id))
                ids += std::string(id) + " ";
        return ids;
    };
    CHECK(seen(scene.visitor("")) == "town ");
    CHECK(seen(scene.visitor(scene.lisa)) == "plant town ");
    CHECK(seen(scene.visitor(scene.tom)) == "plant survey-1 town ");
    CHECK(seen(scene.visitor("", scene.signedFor("survey-1"))) == "survey-1 town ");
    CHECK(outcome(scene.visitor("").refusalOfList()) == "may");
    CHECK(outcome(scene.visitor(scene.lisa).refusalOfList()) == "may");
    CHECK(outcome(scene.visitor(scene.old).refusalOfList()) == "401 invalid_token");
    CHECK(outcome(scene.visitor("Bearer").refusalOfList()) == "400 invalid_request");
}

TEST_CASE("without rules, or with none that hide, everything is public and absent is absent") {
    Scene scene;
    HttpRequest request{"GET", "/", 11, {{"Authorization", "Bearer nonsense"}}};
    scene.rules->privateClouds.clear();
    for (const Visitor& visitor :
         {Visitor(nullptr, request, "", now), Visitor(scene.rules, request, "", now)}) {
        CHECK(visitor.seesAll());
        CHECK(outcome(visitor.refusal("plant", true)) == "may");
        CHECK(outcome(visitor.refusal("nothing", false)) == "may");
        CHECK(outcome(visitor.refusalOfList()) == "may");
        CHECK(visitor.mayRead("plant"));
    }
}
