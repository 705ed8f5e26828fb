#include "server/access/secrets.hpp"

#include <catch2/catch.hpp>
#include <cstdio>

using namespace stipple;
using namespace stipple::server;

namespace {

std::string hex(const Digest& digest) {
    std::string text;
    for (std::uint8_t byte : digest) {
        char two[3];
        std::snprintf(two, sizeof two, "%02x", byte);
        text += two;
    }
    return text;
}

Bytes bytes(std::string_view text) {
    return Bytes(text.begin(), text.end());
}

} // namespace

TEST_CASE("SHA-256 and HMAC-SHA-256 give the published values") {
    CHECK(hex(sha256("abc")) ==
          "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"); // FIPS 180-4
    // RFC 4231, cases 1 and 2.
    CHECK(hex(hmacSha256(Bytes(20, 0x0B), "Hi There")) ==
          "b0344c61d8db38535ca8afceaf0bf12b881dc200c9833da726e9376c2e32cff7");
    CHECK(hex(hmacSha256(bytes("Jefe"), "what do ya want for nothing?")) ==
          "5bdcc146bf60754e6a042426089575c75a003f089d2739839dec58b964ec3843");
}

TEST_CASE("base64url gives the published values without padding, and back") {
    // RFC 4648 §10.
    for (auto [text, encoded] : {std::pair{"", ""},
                                 {"f", "Zg"},
                                 {"fo", "Zm8"},
                                 {"foo", "Zm9v"},
                                 {"foob", "Zm9vYg"},
                                 {"fooba", "Zm9vYmE"},
                                 {"foobar", "Zm9vYmFy"}}) {
        CHECK(base64Url(bytes(text)) == encoded);
        CHECK(fromBase64Url(encoded) == bytes(text));
    }
    CHECK(base64Url(Bytes{0xFB, 0xFF, 0xFE}) == "-__-");
    for (std::size_t size = 0; size < 70; ++size) {
        Bytes value(size);
        for (std::size_t i = 0; i < size; ++i)
            value[i] = static_cast<std::uint8_t>(i * 37 + size);
        CHECK(fromBase64Url(base64Url(value)) == value);
    }
}

TEST_CASE("text that base64url does not give is refused") {
    for (const char* text : {"Z", "Zm9vY", "Zg==", "Zg=", "Z g", "Zm+v", "Zm/v", "Zh", "Zm9", "Zm9v\n"})
        CHECK_FALSE(fromBase64Url(text));
    CHECK(fromBase64Url("Zm8"));
}

TEST_CASE("random bytes differ, and comparing looks at all of them") {
    auto a = randomBytes(32), b = randomBytes(32);
    REQUIRE((a && b));
    CHECK(a->size() == 32);
    CHECK_FALSE(*a == *b);
    CHECK(equalInConstantTime(*a, Bytes(*a)));
    for (std::size_t i = 0; i < a->size(); ++i) {
        Bytes other = *a;
        other[i] ^= 1;
        CHECK_FALSE(equalInConstantTime(*a, other));
    }
    CHECK_FALSE(equalInConstantTime(*a, ByteSpan(*a).first(31)));
    CHECK(equalInConstantTime({}, {}));
}
