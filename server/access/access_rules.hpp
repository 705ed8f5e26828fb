// Who may read which cloud: the contents of an access file, which `stipple access` writes and `stipple serve
// --access FILE` reads. JSON:
//
//   {"version": 1,
//    "private": ["survey-*"], "public": ["survey-demo"],     patterns of ids; what is in both is public
//    "signingKey": "43 characters",                          signs addresses; a secret
//    "tokens": [{"id": "8 characters", "name": "Lisa", "clouds": ["survey-2024"], "salt": "22 characters",
//                "hash": "43 characters", "created": 1767225600, "expires": 1775001600}]}
//
// Binary values are base64url; times are seconds since 1970, 0 for "never". Of a token the file holds only a
// salted SHA-256. A slow hash, as for passwords, would add nothing: those slow down guessing, and 256 random
// bits can't be guessed however fast the hash is; but it would let anybody keep the server busy.
#pragma once

#include "server/access/secrets.hpp"
#include "shared/base/result.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

struct TokenRule {
    std::string id;                  // the token's public part
    std::string name;                // who has it; for people
    std::vector<std::string> clouds; // patterns of ids
    Bytes salt;
    Digest hash{};
    std::int64_t createdSeconds = 0, expiresSeconds = 0; // 0: never

    bool isExpired(std::int64_t nowSeconds) const {
        return expiresSeconds != 0 && expiresSeconds <= nowSeconds;
    }
};

struct AccessRules {
    std::vector<std::string> privateClouds, publicClouds; // patterns of ids; public ones are exceptions
    Bytes signingKey;
    std::vector<TokenRule> tokens;

    bool isPrivate(std::string_view cloudId) const;
    bool hidesAny() const { return !privateClouds.empty(); }
};

// Errors: corrupt, unsupported (another version); each names the member that is at fault.
Result<AccessRules> parseAccessRules(std::string_view text);
std::string accessRulesText(const AccessRules& rules); // indented, with a line end

// Rules without clouds and tokens, with a fresh signing key. Errors: ioFailed (no random bytes).
Result<AccessRules> freshAccessRules();

// Errors: notFound, ioFailed, those of parseAccessRules; invalidArgument if every user of this machine could
// read the file's secrets; limitExceeded beyond 16 MiB.
Result<AccessRules> readAccessFile(const std::string& path);
// Replaces the file at once. It is readable to its owner, and to its group if it was before; never to others.
// Errors: writeFailed.
Status writeAccessFile(const std::string& path, const AccessRules& rules);

} // namespace stipple::server
