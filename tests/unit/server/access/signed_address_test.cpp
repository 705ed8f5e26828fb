#include "server/access/signed_address.hpp"

#include <catch2/catch.hpp>

using namespace stipple;
using namespace stipple::server;

namespace {

constexpr std::int64_t expires = 1'767'225'600;
const Bytes key(32, 0x5A);

bool holds(std::string_view query, std::string_view id = "town", std::int64_t now = expires - 1) {
    return isValid(parseAddressSignature(query), key, id, now);
}

} // namespace

TEST_CASE("a signature is what other programs compute for it") {
    // printf 'stipple address 1\ntown\n1767225600\n' | openssl dgst -sha256 -mac HMAC -macopt hexkey:5a5a…
    // -binary |
    //   basenc --base64url
    CHECK(signedQuery(key, "town", expires) ==
          "expires=1767225600&signature=Nk1mYbSBY2KacDqOPwpUa5zQE9cbU4RK9LMieYT84Pk");
}

TEST_CASE("a signed query holds for its cloud until its moment") {
    std::string query = signedQuery(key, "town", expires);
    CHECK(holds(query));
    CHECK(holds("limit=3&" + query + "&x"));
    CHECK_FALSE(holds(query, "town2"));
    CHECK_FALSE(holds(query, "tow"));
    CHECK_FALSE(holds(query, "town", expires));
    CHECK_FALSE(isValid(parseAddressSignature(query), Bytes(32, 0x5B), "town", expires - 1));
}

TEST_CASE("a signed query with any character changed does not hold") {
    std::string query = signedQuery(key, "town", expires);
    for (std::size_t i = 0; i < query.size(); ++i) {
        INFO(i);
        for (char c : {'0', '1', 'A', '=', '&', '%'}) {
            std::string other = query;
            other[i] = c;
            if (other != query)
                CHECK_FALSE(holds(other));
        }
        CHECK_FALSE(holds(query.substr(0, i)));
    }
}

TEST_CASE("a time or signature in another form, or there twice, is none") {
    std::string query = signedQuery(key, "town", expires);
    std::string signature = query.substr(query.find("signature="));
    for (const char* time : {"expires=01767225600", "expires=+1767225600", "expires=-1",
                             "expires=1767225600.0", "expires=99999999999999999999", "expires=", "expires"})
        CHECK_FALSE(holds(std::string(time) + "&" + signature));
    CHECK_FALSE(holds(query + "&expires=1767225600"));
    CHECK_FALSE(holds(query + "&" + signature));
    CHECK_FALSE(holds(query + "="));
    CHECK_FALSE(holds(""));
    CHECK_FALSE(parseAddressSignature("limit=3&expired=4").isPresent);
    CHECK(parseAddressSignature("expires=4").isPresent);
    CHECK(parseAddressSignature("a&signature").isPresent);
}

TEST_CASE("the rest of a query keeps its order") {
    CHECK(withoutSignature("a=1&" + signedQuery(key, "town", expires) + "&b&&c=%26") == "a=1&b&&c=%26");
    CHECK(withoutSignature(signedQuery(key, "town", expires)).empty());
    CHECK(withoutSignature("").empty());
    for (const char* query : {"expire=1&x", "a&", "&a", "&", "&&", "a=&&b"})
        CHECK(withoutSignature(query) == query);
    CHECK(withoutSignature("signature&a&expires=1") == "a");
}
