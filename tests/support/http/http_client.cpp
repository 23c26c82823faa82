#include "support/http/http_client.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

namespace macadam::testing {

HttpClient::HttpClient(std::uint16_t port) : socket_{socket(AF_INET, SOCK_STREAM, 0)} {
    const timeval wait{.tv_sec = 30, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    static_cast<void>(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address));
}

HttpClient::HttpClient(const std::filesystem::path& unix_socket)
    : socket_{socket(AF_UNIX, SOCK_STREAM, 0)} {
    const timeval wait{.tv_sec = 30, .tv_usec = 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof wait);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    unix_socket.native().copy(address.sun_path, sizeof address.sun_path - 1);
    static_cast<void>(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address));
}

HttpClient::~HttpClient() {
    close(socket_);
}

void HttpClient::send(std::string_view bytes) const {
    while (!bytes.empty()) {
        const auto sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (sent <= 0) {
            return; // the server has closed it
        }
        bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
}

bool HttpClient::read_more() {
    std::array<char, 65536> buffer{};
    const auto got = recv(socket_, buffer.data(), buffer.size(), 0);
    if (got > 0) {
        read_.append(buffer.data(), static_cast<std::size_t>(got));
    }
    return got > 0;
}

bool HttpClient::is_closed() {
    errno = 0; // an end leaves it as it was
    while (read_more()) {
    }
    return errno != EAGAIN;
}

Answer HttpClient::answer(bool has_body) {
    std::size_t end = 0;
    while ((end = read_.find("\r\n\r\n")) == std::string::npos) {
        if (!read_more()) {
            return {};
        }
    }
    Answer answer;
    std::string_view head{read_.data(), end};
    answer.status = std::stoi(std::string{head.substr(9, 3)}); // after "HTTP/1.1 "
    while (head.find("\r\n") != std::string_view::npos) {
        head.remove_prefix(head.find("\r\n") + 2);
        const auto line = head.substr(0, head.find("\r\n"));
        const auto colon = line.find(": ");
        std::string name{line.substr(0, colon)};
        std::ranges::transform(name, name.begin(), [](unsigned char letter) {
            return static_cast<char>(std::tolower(letter));
        });
        answer.headers.emplace(name, line.substr(colon + 2));
    }
    const auto length = answer.headers.contains("content-length") && has_body
                            ? std::stoul(answer.headers["content-length"])
                            : 0;
    read_.erase(0, end + 4);
    while (read_.size() < length) {
        if (!read_more()) {
            break;
        }
    }
    answer.body = read_.substr(0, length);
    read_.erase(0, length);
    return answer;
}

std::string HttpClient::read_until(std::string_view words) {
    while (read_.find(words) == std::string::npos && read_more()) {
    }
    const auto at = read_.find(words);
    const auto size = at == std::string::npos ? read_.size() : at + words.size();
    auto text = read_.substr(0, size);
    read_.erase(0, size);
    return text;
}

std::uint16_t quiet_port() {
    constexpr int first = 10'000, count = 22'000; // Linux gives clients those from 32768 on
    static std::atomic<int> asked = 0;
    for (;;) {
        // Tests that run at the same time begin at different ones.
        const auto port = static_cast<std::uint16_t>(first + (::getpid() + 7919 * asked++) % count);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const int probe = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        const int code = bind(probe, reinterpret_cast<sockaddr*>(&address), sizeof address);
        close(probe);
        if (code == 0) {
            return port;
        }
    }
}

Answer get(std::uint16_t port, std::string_view target, std::string_view headers) {
    HttpClient client{port};
    client.send(
        fmt::format("GET {} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\n{}\r\n", target, port, headers));
    return client.answer();
}

} // namespace macadam::testing
