// Bearer tokens (RFC 6750): "stipple_" ID "_" SECRET, where ID (8 characters) is how the server finds what
// it knows of the token, and SECRET (43 characters) is 256 random bits. The prefix lets tools that look for
// leaked secrets recognize it.
#pragma once

#include "server/access/access_rules.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

inline constexpr std::size_t tokenSaltBytes = 16;

struct NewToken {
    TokenRule rule;
    std::string text; // shown once, kept nowhere
};
// `id`s of `rules` are not used again. Errors: ioFailed (no random bytes).
Result<NewToken> makeToken(const AccessRules& rules, std::string name, std::vector<std::string> clouds,
                           std::int64_t nowSeconds, std::int64_t expiresSeconds);

// The rule of a token, or null if it is malformed, unknown or not that rule's. An expired one is found.
const TokenRule* findToken(const AccessRules& rules, std::string_view text);

bool isTokenId(std::string_view id);

// What the field Authorization brings.
enum class BearerKind {
    none,      // no field, or another scheme than Bearer
    malformed, // Bearer without a token, or more than one field
    token,
};
struct Bearer {
    BearerKind kind = BearerKind::none;
    std::string token;
};
// `field`: the value of Authorization, if there is one; `count`: how many lines of it.
Bearer parseBearer(const std::optional<std::string>& field, int count);

} // namespace stipple::server
