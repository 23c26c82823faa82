#include "app/http/listening_socket.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace macadam {

int open_listening_socket(const std::string& host, std::uint16_t port) {
    addrinfo hints{};
    hints.ai_family = AF_UNSPEC;
    hints.ai_socktype = SOCK_STREAM;
    hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV | AI_PASSIVE;
    addrinfo* found = nullptr;
    if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &found) != 0) {
        throw InputError{fmt::format("'{}' is no address, expected one such as 127.0.0.1", host)};
    }
    const std::unique_ptr<addrinfo, void (*)(addrinfo*)> address{found, freeaddrinfo};
    const int listening = socket(
        address->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, address->ai_protocol);
    const int on = 1;
    if (listening < 0 || setsockopt(listening, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on) != 0 ||
        bind(listening, address->ai_addr, address->ai_addrlen) != 0 ||
        listen(listening, SOMAXCONN) != 0) {
        const auto reason = std::string{std::strerror(errno)};
        if (listening >= 0) {
            close(listening);
        }
        throw InputError{fmt::format(
            "cannot listen on {} port {}: {}; choose another with --listen", host, port, reason)};
    }
    return listening;
}

std::uint16_t port_of(int listening_socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    getsockname(listening_socket, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.ss_family == AF_INET6
                     ? reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port
                     : reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

bool is_loopback(std::string_view host) {
    in_addr address{}; // a name such as 127.example.org is none
    constexpr std::uint32_t net = 127U << 24U, net_mask = 255U << 24U;
    return host == "::1" || (inet_pton(AF_INET, std::string{host}.c_str(), &address) == 1 &&
                             (ntohl(address.s_addr) & net_mask) == net);
}

std::string peer_of(int connected_socket) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    std::array<char, NI_MAXHOST> name{};
    if (getpeername(connected_socket, reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
        getnameinfo(reinterpret_cast<sockaddr*>(&address),
                    size,
                    name.data(),
                    name.size(),
                    nullptr,
                    0,
                    NI_NUMERICHOST) != 0) {
        return {};
    }
    return name.data();
}

} // namespace macadam
