#include "server/net/client_address.hpp"

#include "server/http/message.hpp"

#include <algorithm>

namespace stipple::server {

namespace ip = boost::asio::ip;

std::string clientGroup(const ip::address& address) {
    if (address.is_v4())
        return address.to_string();
    ip::address_v6 v6 = address.to_v6();
    if (v6.is_v4_mapped())
        return ip::make_address_v4(ip::v4_mapped, v6).to_string();
    auto bytes = v6.to_bytes();
    std::fill(bytes.begin() + 8, bytes.end(), std::uint8_t{0});
    return ip::address_v6(bytes).to_string() + "/64";
}

ip::address forwardedClient(std::string_view forwardedFor, const ip::address& peer,
                            const std::vector<ip::address>& trusted) {
    while (!forwardedFor.empty()) {
        std::size_t comma = forwardedFor.rfind(',');
        bool isLast = comma == std::string_view::npos;
        boost::system::error_code problem;
        auto address =
            ip::make_address(std::string(trimmed(forwardedFor.substr(isLast ? 0 : comma + 1))), problem);
        if (problem)
            return peer;
        if (std::find(trusted.begin(), trusted.end(), address) == trusted.end())
            return address;
        forwardedFor = forwardedFor.substr(0, isLast ? 0 : comma);
    }
    return peer;
}

} // namespace stipple::server
