// The few pieces of cryptography that access control needs, from OpenSSL: hashes, random bytes, comparing
// without telling by its time where two values differ, and base64url (RFC 4648 §5, without padding).
// Thread: any.
#pragma once

#include "shared/base/bytes.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stipple::server {

inline constexpr std::size_t secretBytes = 32; // 256 bits: nobody guesses one
using Digest = std::array<std::uint8_t, 32>;   // of SHA-256 (FIPS 180-4)

Digest sha256(std::string_view text);
Digest hmacSha256(ByteSpan key, std::string_view text); // RFC 2104

// Unpredictable bytes of the operating system's generator. Nothing if that has failed.
std::optional<Bytes> randomBytes(std::size_t count);

// Takes the same time wherever the first difference is; sizes are no secret.
bool equalInConstantTime(ByteSpan a, ByteSpan b);

std::string base64Url(ByteSpan bytes);
// Nothing if `text` has other characters, padding, an impossible length or stray bits in its last character:
// each value has one text.
std::optional<Bytes> fromBase64Url(std::string_view text);

} // namespace stipple::server
