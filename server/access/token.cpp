#include "server/access/token.hpp"

#include "server/http/message.hpp"
#include "shared/base/text.hpp"

#include <algorithm>
#include <cctype>

namespace stipple::server {

namespace {

constexpr std::string_view prefix = "stipple_";
constexpr std::size_t idBytes = 6, idLength = 8, secretLength = 43;
static_assert(idBytes * 4 == idLength * 3 && (secretBytes * 4 + 2) / 3 == secretLength);

Digest saltedHash(const Bytes& salt, std::string_view token) {
    std::string text(salt.begin(), salt.end());
    text += token;
    return sha256(text);
}

bool hasRule(const AccessRules& rules, std::string_view id) {
    return std::any_of(rules.tokens.begin(), rules.tokens.end(),
                       [&](const TokenRule& rule) { return rule.id == id; });
}

// RFC 6750 §2.1: letters, digits and "-._~+/", then any number of "=".
bool isB64Token(std::string_view text) {
    std::size_t end = text.find_last_not_of('=');
    return end != std::string_view::npos && std::all_of(text.begin(), text.begin() + end + 1, [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) ||
                      std::string_view("-._~+/").find(c) != std::string_view::npos;
           });
}

} // namespace

Result<NewToken> makeToken(const AccessRules& rules, std::string name, std::vector<std::string> clouds,
                           std::int64_t nowSeconds, std::int64_t expiresSeconds) {
    NewToken token;
    do {
        auto id = randomBytes(idBytes), secret = randomBytes(secretBytes), salt = randomBytes(tokenSaltBytes);
        if (!id || !secret || !salt)
            return Error{ErrorCode::ioFailed, "the system gives no random bytes", "", ""};
        token.rule.id = base64Url(*id);
        token.rule.salt = *salt;
        token.text = cat(prefix, token.rule.id, "_", base64Url(*secret));
    } while (hasRule(rules, token.rule.id));
    token.rule.hash = saltedHash(token.rule.salt, token.text);
    token.rule.name = std::move(name);
    token.rule.clouds = std::move(clouds);
    token.rule.createdSeconds = nowSeconds;
    token.rule.expiresSeconds = expiresSeconds;
    return token;
}

const TokenRule* findToken(const AccessRules& rules, std::string_view text) {
    if (text.size() != prefix.size() + idLength + 1 + secretLength || !text.starts_with(prefix))
        return nullptr;
    std::string_view id = text.substr(prefix.size(), idLength);
    auto rule = std::find_if(rules.tokens.begin(), rules.tokens.end(),
                             [&](const TokenRule& candidate) { return candidate.id == id; });
    if (rule == rules.tokens.end() || !equalInConstantTime(saltedHash(rule->salt, text), rule->hash))
        return nullptr;
    return &*rule;
}

bool isTokenId(std::string_view id) {
    return id.size() == idLength && fromBase64Url(id).has_value();
}

Bearer parseBearer(const std::optional<std::string>& field, int count) {
    constexpr std::string_view scheme = "Bearer";
    if (!field)
        return {};
    if (count > 1)
        return {BearerKind::malformed, ""};
    std::string_view value = trimmed(*field);
    std::size_t end = std::min(value.find_first_of(" \t"), value.size());
    if (!equalIgnoringCase(value.substr(0, end), scheme))
        return {};
    std::string_view token = trimmed(value.substr(end));
    if (!isB64Token(token))
        return {BearerKind::malformed, ""};
    return {BearerKind::token, std::string(token)};
}

} // namespace stipple::server
