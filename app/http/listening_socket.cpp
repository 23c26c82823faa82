#include "app/http/listening_socket.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>
#include <utility>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
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

namespace {

constexpr mode_t owner_and_group = 0660;

/// Descriptor that is closed unless it is released.
class OwnedSocket {
public:
    explicit OwnedSocket(int number) : number_{number} {}
    OwnedSocket(const OwnedSocket&) = delete;
    OwnedSocket& operator=(const OwnedSocket&) = delete;
    ~OwnedSocket() {
        if (number_ >= 0) {
            close(number_);
        }
    }
    int number() const { return number_; }
    int release() { return std::exchange(number_, -1); }

private:
    int number_;
};

/// Removes a socket on which nobody listens any longer.
void remove_dead_socket(const std::filesystem::path& file, const sockaddr_un& address) {
    struct stat found {};
    if (lstat(file.c_str(), &found) != 0 || !S_ISSOCK(found.st_mode)) {
        return;
    }
    const OwnedSocket probe{socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
    const bool is_dead =
        connect(probe.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 &&
        errno == ECONNREFUSED;
    if (is_dead) {
        unlink(file.c_str());
    }
}

} // namespace

int open_listening_socket(const std::filesystem::path& file) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const auto& path = file.native();
    if (path.empty() || path.size() >= sizeof address.sun_path) {
        throw InputError{fmt::format("'{}' is no name of a Unix socket, expected 1 to {} bytes",
                                     path,
                                     sizeof address.sun_path - 1)};
    }
    path.copy(address.sun_path, path.size());
    remove_dead_socket(file, address);
    OwnedSocket listening{socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
    // The file gets the permissions of the descriptor less the umask, then all of them.
    if (listening.number() < 0 || fchmod(listening.number(), owner_and_group) != 0 ||
        bind(listening.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) !=
            0 ||
        chmod(file.c_str(), owner_and_group) != 0 || listen(listening.number(), SOMAXCONN) != 0) {
        throw InputError{fmt::format(
            "cannot listen on {}: {}; choose another with --listen", path, std::strerror(errno))};
    }
    return listening.release();
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
        address.ss_family == AF_UNIX ||
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
