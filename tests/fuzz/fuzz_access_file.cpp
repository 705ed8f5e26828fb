// Access files: whatever is accepted is written again as the same rules, and decides without failing.
#include "server/access/id_pattern.hpp"
#include "server/access/token.hpp"

#include <cstdlib>

using namespace stipple::server;

namespace {

void require(bool holds) {
    if (!holds)
        std::abort();
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    std::string_view text(reinterpret_cast<const char*>(data), size);
    auto rules = parseAccessRules(text);
    if (!rules)
        return 0;
    require(rules->signingKey.size() == secretBytes);
    auto again = parseAccessRules(accessRulesText(*rules));
    require(again.ok() && accessRulesText(*again) == accessRulesText(*rules));
    for (const TokenRule& token : rules->tokens) {
        require(isTokenId(token.id) && token.salt.size() == tokenSaltBytes && token.expiresSeconds >= 0);
        require(findToken(*rules, "stipple_" + token.id + "_" + std::string(43, 'A')) == nullptr);
    }
    for (const std::string& pattern : rules->privateClouds) {
        require(isIdPattern(pattern) && matchesPattern(pattern, pattern)); // a star matches a star
        require(rules->isPrivate(pattern) || matchesAny(rules->publicClouds, pattern));
    }
    return 0;
}
