#pragma once

#include "app/http/http_message.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// Workers for requests of one kind, which hold up no others.
struct HttpLane {
    std::size_t workers = 1;
    std::size_t max_waiting = 512;  ///< requests; more are refused
    std::size_t max_per_client = 0; ///< requests of one client that wait or are at work; 0: any
};

/// Limits of a server (docs/reference/serve.md).
struct HttpServerConfig {
    std::string host = "127.0.0.1";      ///< an address, not a name
    std::uint16_t port = 8080;           ///< 0: any free one
    std::filesystem::path unix_socket{}; ///< listened on in place of host and port, unless empty
    std::size_t workers = 2;             ///< of lane 0
    std::vector<HttpLane> lanes{};       ///< lanes 1, 2, ..., whose workers have the next numbers
    bool behind_proxy = false; ///< clients are told apart by the last address of X-Forwarded-For
    std::vector<std::string> hosts{}; ///< accepted in the header Host, beside loopback ones
    std::vector<std::string> allowed_origins{}; ///< of CORS (cross_origin.hpp)

    std::size_t max_connections = 2000;
    std::size_t max_per_address = 64; ///< connections; behind a proxy, requests at work
    /// Bytes of large answers that one address has asked for and not read; one may be larger.
    std::uint64_t max_unread_per_address = std::uint64_t{64} << 20U;
    std::size_t max_head_bytes = std::size_t{16} * 1024;
    std::size_t max_target_bytes = std::size_t{8} * 1024;
    std::size_t max_waiting = 512; ///< requests that wait for a worker
    std::chrono::milliseconds head_time{10'000};
    std::chrono::milliseconds response_time{60'000};    ///< and 1 s more for each slowest_bytes
    std::chrono::milliseconds body_time{60'000};        ///< in the same way
    std::size_t slowest_bytes = std::size_t{64} * 1024; ///< a second, of a reader or sender
    std::size_t slowest_upload_bytes = std::size_t{8} * 1024; ///< of the sender of an admitted body

    /// Limit of a request's body; 0: none has one, and there is no other method than GET and HEAD.
    std::uint64_t max_body_bytes = 0;
};

/// Measurement of one answered request.
struct HttpRecord {
    std::string_view method;
    std::string_view route; ///< pattern, never the path or query, which can be positions
    int status;
    std::uint64_t bytes;
    std::chrono::microseconds duration; ///< from head to queued response
};

/// Decision about a request whose head has been read.
struct HttpAdmission {
    std::optional<HttpResponse> refusal{}; ///< sent in place of an answer
    std::shared_ptr<HttpBody> body{};      ///< receives the request's body; null: it is dropped
};

/// Functions that answer requests. Exceptions become a response of status 500 that tells no more.
struct HttpHandlers {
    /// Called by a worker of that number, less than the workers of all lanes.
    std::function<HttpResponse(const HttpRequest&, std::size_t worker)> answer;

    /// Called by the thread of the network, so that no slow answer delays it; `std::nullopt`: the
    /// request is for a worker.
    std::function<std::optional<HttpResponse>(const HttpRequest&)> answer_at_once{};

    /// Called by the thread of the network, after `answer_at_once`; missing: all are admitted.
    std::function<HttpAdmission(const HttpRequest&)> admit{};

    /// Lane whose workers receive the body of an admitted request and answer it; missing: 0.
    std::function<std::size_t(const HttpRequest&)> lane{};

    /// Tells whether pages of allowed origins may read the answer to a request; missing: to all.
    std::function<bool(const HttpRequest&)> is_public{};

    std::function<void(const HttpRecord&)> record{}; ///< from one thread
    std::function<void(const std::string& route, const std::string& what)> failed{};
};

/// HTTP/1.1 server on one address, for GET and HEAD, and for PUT, POST and DELETE if it takes
/// bodies. One thread reads and writes all connections (epoll); workers compute the responses.
class HttpServer {
public:
    /// Starts to listen.
    /// \throws InputError  if the address cannot be listened on.
    HttpServer(HttpServerConfig config, HttpHandlers handlers);
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;
    ~HttpServer();

    std::uint16_t port() const; ///< 0 for a Unix socket
    std::size_t connections() const;

    /// Stops listening, and waits until the requests at work are answered, or until the time is
    /// over.
    void drain(std::chrono::milliseconds at_most);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace macadam
