// Who a client is: for the log, and for limits that hold for each client. Internal to server/net.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace stipple::server {

// Whom limits count an address for: an IPv4 address by itself (also one mapped into IPv6), an IPv6 address
// with the 2^64 others of its network, which are usually one customer's: "2001:db8:1:2::/64".
std::string clientGroup(const boost::asio::ip::address& address);

// The address that a request came from, by the list of X-Forwarded-For that proxies add to on its right: the
// last one that is no trusted proxy's. `peer` where the list is malformed before one is found, or empty.
// Whoever `peer` is has to be trusted already.
boost::asio::ip::address forwardedClient(std::string_view forwardedFor, const boost::asio::ip::address& peer,
                                         const std::vector<boost::asio::ip::address>& trusted);

} // namespace stipple::server
