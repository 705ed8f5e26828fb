#include "server/net/client_address.hpp"

#include <catch2/catch.hpp>

using namespace stipple::server;
using boost::asio::ip::make_address;

TEST_CASE("limits hold for an IPv4 address, and for an IPv6 network of 64 bits") {
    CHECK(clientGroup(make_address("192.0.2.7")) == "192.0.2.7");
    CHECK(clientGroup(make_address("::ffff:192.0.2.7")) == "192.0.2.7");
    CHECK(clientGroup(make_address("2001:db8:1:2:3:4:5:6")) == "2001:db8:1:2::/64");
    CHECK(clientGroup(make_address("2001:db8:1:2::9")) == "2001:db8:1:2::/64");
    CHECK(clientGroup(make_address("2001:db8:1:3::9")) != "2001:db8:1:2::/64");
}

TEST_CASE("a proxy's client is the last address that is no proxy of ours") {
    auto peer = make_address("10.0.0.1");
    auto from = [&](const char* field) {
        return forwardedClient(field, peer, {peer, make_address("10.0.0.2")}).to_string();
    };
    CHECK(from("192.0.2.7") == "192.0.2.7");
    CHECK(from("6.6.6.6, 192.0.2.7") == "192.0.2.7");
    CHECK(from("192.0.2.7,10.0.0.2 , 10.0.0.1") == "192.0.2.7");
    CHECK(from("2001:db8::1") == "2001:db8::1");
    CHECK(from("") == "10.0.0.1");
    CHECK(from("10.0.0.2") == "10.0.0.1");
    CHECK(from("192.0.2.7, nonsense") == "10.0.0.1");
    CHECK(from("192.0.2.7, ") == "10.0.0.1");
    CHECK(from(",,,") == "10.0.0.1");
    CHECK(from("192.0.2.7:80") == "10.0.0.1");
}
