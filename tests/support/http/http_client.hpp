#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace macadam::testing {

/// Response as a client reads it; header names in lower case.
struct Answer {
    int status = 0; ///< 0: the server closed the connection without one
    std::map<std::string, std::string, std::less<>> headers;
    std::string body;
};

/// Connection to a server on 127.0.0.1; without one, answers have status 0. Reading ends after 30
/// s.
class HttpClient {
public:
    explicit HttpClient(std::uint16_t port);
    explicit HttpClient(const std::filesystem::path& unix_socket);
    HttpClient(const HttpClient&) = delete;
    HttpClient& operator=(const HttpClient&) = delete;
    ~HttpClient();

    void send(std::string_view bytes) const;
    Answer answer(bool has_body = true);            ///< reads one response
    std::string read_until(std::string_view words); ///< reads until they have come, or the end
    bool is_closed();                               ///< waits until the server closes it

private:
    bool read_more();

    int socket_;
    std::string read_;
};

/// Port of 127.0.0.1 that nobody listens on, for a server that is started on it again and again. It
/// is none of those that the system gives to clients, which would take it between two starts.
std::uint16_t quiet_port();

/// Asks by GET, with further header lines, each with its line end.
Answer get(std::uint16_t port, std::string_view target, std::string_view headers = {});

} // namespace macadam::testing
