#include "server/access/secrets.hpp"

#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

namespace stipple::server {

namespace {

constexpr std::string_view alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_";

const std::uint8_t* bytesOf(std::string_view text) {
    return reinterpret_cast<const std::uint8_t*>(text.data());
}

} // namespace

Digest sha256(std::string_view text) {
    Digest digest;
    ::SHA256(bytesOf(text), text.size(), digest.data());
    return digest;
}

Digest hmacSha256(ByteSpan key, std::string_view text) {
    Digest digest;
    unsigned size = static_cast<unsigned>(digest.size());
    ::HMAC(::EVP_sha256(), key.data(), static_cast<int>(key.size()), bytesOf(text), text.size(),
           digest.data(), &size);
    return digest;
}

std::optional<Bytes> randomBytes(std::size_t count) {
    Bytes bytes(count);
    if (::RAND_bytes(bytes.data(), static_cast<int>(count)) != 1)
        return std::nullopt;
    return bytes;
}

bool equalInConstantTime(ByteSpan a, ByteSpan b) {
    return a.size() == b.size() && ::CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0;
}

std::string base64Url(ByteSpan bytes) {
    std::string text;
    std::uint32_t bits = 0;
    int count = 0; // of bits that are in no character yet; they are the low ones
    for (std::uint8_t byte : bytes) {
        bits = bits << 8 | byte;
        for (count += 8; count >= 6; count -= 6)
            text += alphabet[bits >> (count - 6) & 63];
    }
    if (count > 0)
        text += alphabet[bits << (6 - count) & 63];
    return text;
}

std::optional<Bytes> fromBase64Url(std::string_view text) {
    Bytes bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (char c : text) {
        std::size_t value = alphabet.find(c);
        if (value == std::string_view::npos)
            return std::nullopt;
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> count));
        }
    }
    // 4 characters are 3 bytes; one character left over is no byte at all.
    if (count >= 6 || (bits & ((1u << count) - 1)) != 0)
        return std::nullopt;
    return bytes;
}

} // namespace stipple::server
