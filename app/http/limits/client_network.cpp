#include "app/http/limits/client_network.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace macadam {

std::string client_network(std::string_view address) {
    in6_addr ip{};
    if (inet_pton(AF_INET6, std::string{address}.c_str(), &ip) != 1) {
        return std::string{address};
    }
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (IN6_IS_ADDR_V4MAPPED(&ip)) {
        constexpr std::size_t before = 12; // bytes
        inet_ntop(AF_INET, &ip.s6_addr[before], text.data(), text.size());
        return text.data();
    }
    constexpr std::size_t network_bytes = 8;
    std::fill(std::begin(ip.s6_addr) + network_bytes, std::end(ip.s6_addr), 0);
    inet_ntop(AF_INET6, &ip, text.data(), text.size());
    return std::string{text.data()} + "/64";
}

} // namespace macadam
