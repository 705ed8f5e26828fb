// Signed addresses: a query that lets whoever has it read one cloud until a moment, with no token.
//
//   /clouds/town.stipple?expires=1767225600&signature=uGZz…
//
// The signature is base64url(HMAC-SHA256(signingKey, "stipple address 1\n" ID "\n" EXPIRES "\n")). It holds
// for every address of the cloud: its file and what lies below /api/v1/clouds/ID. Programs with the key can
// make them; a new key ends them all.
#pragma once

#include "server/access/secrets.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

// "expires=…&signature=…". `expiresSeconds` since 1970, not negative.
std::string signedQuery(ByteSpan key, std::string_view cloudId, std::int64_t expiresSeconds);

struct AddressSignature {
    bool isPresent = false; // one of the two parameters is there
    // Nothing if a parameter is absent, there twice, or not in the one form that signedQuery gives it.
    struct Values {
        std::int64_t expiresSeconds = 0;
        std::string signature;
    };
    std::optional<Values> values;
};
// `query` without "?", not decoded.
AddressSignature parseAddressSignature(std::string_view query);

// True if `signature` was made with `key` for this cloud and its time is not over.
bool isValid(const AddressSignature& signature, ByteSpan key, std::string_view cloudId,
             std::int64_t nowSeconds);

// `query` without the parameters of the signature, for endpoints that know all of theirs.
std::string withoutSignature(std::string_view query);

} // namespace stipple::server
