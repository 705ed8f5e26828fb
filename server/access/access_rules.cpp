#include "server/access/access_rules.hpp"

#include "server/access/id_pattern.hpp"
#include "server/access/token.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace stipple::server {

namespace {

using Json = nlohmann::ordered_json;
constexpr int fileVersion = 1;

Error damaged(std::string what) {
    return {ErrorCode::corrupt, std::move(what), "", "mend it, or make a new one with `stipple access`"};
}

Result<std::vector<std::string>> readPatterns(const Json& object, const char* name) {
    std::vector<std::string> patterns;
    auto list = object.find(name);
    if (list == object.end())
        return patterns;
    if (!list->is_array())
        return damaged(cat("\"", name, "\" is no list"));
    for (const Json& pattern : *list) {
        if (!pattern.is_string() || !isIdPattern(pattern.get<std::string>()))
            return damaged(
                cat("\"", name, "\" has an element that is no cloud's id, nor one with \"*\" in it"));
        patterns.push_back(pattern.get<std::string>());
    }
    return patterns;
}

Result<Bytes> readBinary(const Json& object, const char* name, std::size_t size) {
    auto text = object.find(name);
    std::optional<Bytes> bytes;
    if (text != object.end() && text->is_string())
        bytes = fromBase64Url(text->get<std::string>());
    if (!bytes || bytes->size() != size)
        return damaged(cat("\"", name, "\" is not ", size, " bytes of base64url"));
    return *bytes;
}

Result<std::int64_t> readTime(const Json& object, const char* name) {
    auto number = object.find(name);
    if (number == object.end())
        return std::int64_t{0};
    if (!number->is_number_integer() || number->get<std::int64_t>() < 0)
        return damaged(cat("\"", name, "\" is no time in seconds since 1970"));
    return number->get<std::int64_t>();
}

Result<std::string> readText(const Json& object, const char* name) {
    auto text = object.find(name);
    if (text == object.end() || !text->is_string())
        return damaged(cat("\"", name, "\" is no text"));
    return text->get<std::string>();
}

Result<TokenRule> readToken(const Json& object) {
    if (!object.is_object())
        return damaged("an element of \"tokens\" is no object");
    TokenRule rule;
    STIPPLE_TRY(id, readText(object, "id"));
    STIPPLE_TRY(name, readText(object, "name"));
    STIPPLE_TRY(clouds, readPatterns(object, "clouds"));
    STIPPLE_TRY(salt, readBinary(object, "salt", tokenSaltBytes));
    STIPPLE_TRY(hash, readBinary(object, "hash", rule.hash.size()));
    STIPPLE_TRY(created, readTime(object, "created"));
    STIPPLE_TRY(expires, readTime(object, "expires"));
    if (!isTokenId(id))
        return damaged("\"id\" of a token is not 8 characters of base64url");
    rule.id = id;
    rule.name = name;
    rule.clouds = clouds;
    rule.salt = salt;
    std::copy(hash.begin(), hash.end(), rule.hash.begin());
    rule.createdSeconds = created;
    rule.expiresSeconds = expires;
    return rule;
}

Json tokenJson(const TokenRule& rule) {
    return {{"id", rule.id},
            {"name", rule.name},
            {"clouds", rule.clouds},
            {"salt", base64Url(rule.salt)},
            {"hash", base64Url(rule.hash)},
            {"created", rule.createdSeconds},
            {"expires", rule.expiresSeconds}};
}

} // namespace

bool AccessRules::isPrivate(std::string_view cloudId) const {
    return matchesAny(privateClouds, cloudId) && !matchesAny(publicClouds, cloudId);
}

Result<AccessRules> parseAccessRules(std::string_view text) {
    Json json = Json::parse(text, nullptr, false);
    if (!json.is_object())
        return damaged("is no JSON object");
    if (json.value("version", Json()) != fileVersion)
        return Error{ErrorCode::unsupported, cat("\"version\" is not ", fileVersion), "", ""};
    AccessRules rules;
    STIPPLE_TRY(privateClouds, readPatterns(json, "private"));
    STIPPLE_TRY(publicClouds, readPatterns(json, "public"));
    STIPPLE_TRY(signingKey, readBinary(json, "signingKey", secretBytes));
    rules.privateClouds = privateClouds;
    rules.publicClouds = publicClouds;
    rules.signingKey = signingKey;
    auto tokens = json.find("tokens");
    if (tokens == json.end())
        return rules;
    if (!tokens->is_array())
        return damaged("\"tokens\" is no list");
    for (const Json& object : *tokens) {
        STIPPLE_TRY(token, readToken(object));
        bool isTaken = std::any_of(rules.tokens.begin(), rules.tokens.end(),
                                   [&](const TokenRule& other) { return other.id == token.id; });
        if (isTaken)
            return damaged(cat("two tokens have the \"id\" ", token.id));
        rules.tokens.push_back(token);
    }
    return rules;
}

std::string accessRulesText(const AccessRules& rules) {
    Json tokens = Json::array();
    for (const TokenRule& rule : rules.tokens)
        tokens.push_back(tokenJson(rule));
    Json json{{"version", fileVersion},
              {"private", rules.privateClouds},
              {"public", rules.publicClouds},
              {"signingKey", base64Url(rules.signingKey)},
              {"tokens", std::move(tokens)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Result<AccessRules> freshAccessRules() {
    auto key = randomBytes(secretBytes);
    if (!key)
        return Error{ErrorCode::ioFailed, "the system gives no random bytes", "", ""};
    AccessRules rules;
    rules.signingKey = *key;
    return rules;
}

} // namespace stipple::server
