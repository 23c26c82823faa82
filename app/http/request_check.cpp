#include "app/http/request_check.hpp"

#include "app/http/limits/client_network.hpp"
#include "app/http/listening_socket.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <system_error>

namespace macadam {
namespace {

std::string lower_case(std::string_view text) {
    std::string lower{text};
    std::ranges::transform(lower, lower.begin(), [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    });
    return lower;
}

/// Returns "::1" for "[::1]:8080", and "" for what is no host.
std::string_view name_of_host(std::string_view host) {
    const auto end = host.starts_with('[') ? host.find(']') : host.find(':');
    const auto port = end == std::string_view::npos ? "" : host.substr(end);
    if (!host.starts_with('[')) {
        return host.substr(0, end);
    }
    return port == "]" || port.starts_with("]:") ? host.substr(1, end - 1) : "";
}

bool is_known_host(const std::string& host, const HttpServerConfig& config) {
    constexpr std::string_view allowed = "abcdefghijklmnopqrstuvwxyz0123456789.-:[]";
    if (host.find_first_not_of(allowed) != std::string::npos) {
        return false;
    }
    const auto name = name_of_host(host);
    return name == "localhost" || is_loopback(name) ||
           std::ranges::any_of(config.hosts, [&](const std::string& known) {
               return name == name_of_host(lower_case(known)); // a proxy may leave out the port
           });
}

std::size_t size_of(const RequestHead& head) {
    constexpr std::size_t around_line = 12, around_header = 4; // " HTTP/1.1\r\n", ": " and "\r\n"
    std::size_t bytes = head.method.size() + head.target.size() + around_line;
    for (const auto& [name, value] : head.headers) {
        bytes += name.size() + value.size() + around_header;
    }
    return bytes;
}

std::size_t count_of(const RequestHead& head, std::string_view name) {
    return static_cast<std::size_t>(std::ranges::count_if(
        head.headers, [&](const auto& header) { return lower_case(header.first) == name; }));
}

bool is_reading(const HttpRequest& request) {
    return request.method == "GET" || request.method == "HEAD";
}

std::optional<HttpResponse> refused_method(const HttpRequest& request,
                                           const HttpServerConfig& config) {
    constexpr std::array writing{"PUT", "POST", "DELETE"};
    const bool is_known =
        is_reading(request) || (request.method == "OPTIONS" && !config.allowed_origins.empty()) ||
        (config.max_body_bytes > 0 && std::ranges::count(writing, request.method) > 0);
    if (is_known) {
        return std::nullopt;
    }
    auto refusal = http_problem(405, "expected GET or HEAD");
    refusal.headers.emplace_back("Allow", "GET, HEAD");
    return refusal;
}

std::optional<HttpResponse> refused_body(const HttpRequest& request,
                                         const HttpServerConfig& config) {
    const auto length = request.header("content-length");
    const bool is_chunked = request.headers.contains("transfer-encoding");
    if (is_reading(request) || request.method == "OPTIONS") {
        return !is_chunked && (length.empty() || length == "0")
                   ? std::nullopt
                   : std::optional{http_problem(413, "requests have no body here")};
    }
    if (is_chunked || (length.empty() && request.method == "PUT")) {
        return http_problem(411, "expected a header Content-Length");
    }
    if (body_bytes_of(request) > config.max_body_bytes) {
        return http_problem(413, fmt::format("expected at most {} bytes", config.max_body_bytes));
    }
    return std::nullopt;
}

/// Ends the connection after a response, as what follows may be a body rather than a request.
HttpResponse cut_off(HttpResponse response) {
    response.headers.emplace_back("Connection", "close");
    return response;
}

/// Takes the host of a target in absolute form, "http://localhost:8080/api", which is instead of
/// the header (RFC 9112, 3.2.2); leaves its path and query.
std::string path_and_query(std::string_view target, HttpRequest& request) {
    const auto lower = lower_case(target.substr(0, std::string_view{"https://"}.size()));
    const auto scheme = lower.starts_with("http://") ? std::string_view{"http://"}.size()
                        : lower == "https://"        ? lower.size()
                                                     : 0;
    if (scheme == 0) {
        return std::string{target};
    }
    target.remove_prefix(scheme);
    const auto host = target.substr(0, target.find_first_of("/?"));
    request.headers["host"] = host;
    target.remove_prefix(host.size());
    return target.starts_with('/') ? std::string{target} : fmt::format("/{}", target);
}

} // namespace

std::uint64_t body_bytes_of(const HttpRequest& request) {
    const auto length = request.header("content-length");
    std::uint64_t bytes = 0;
    const auto [end, error] = std::from_chars(length.data(), length.data() + length.size(), bytes);
    const bool is_number = error == std::errc{} && end == length.data() + length.size();
    return length.empty() ? 0 : is_number ? bytes : std::numeric_limits<std::uint64_t>::max();
}

std::optional<HttpResponse>
decode_head(const RequestHead& head, const HttpServerConfig& config, HttpRequest& request) {
    request.method = head.method;
    if (head.target.size() > config.max_target_bytes) {
        return http_problem(414, fmt::format("expected at most {} bytes", config.max_target_bytes));
    }
    if (size_of(head) > config.max_head_bytes) {
        return http_problem(431, fmt::format("expected at most {} bytes", config.max_head_bytes));
    }
    for (const auto& [name, value] : head.headers) {
        if (name.find_first_of(" \t") != std::string_view::npos) { // RFC 9112, 5.1
            return cut_off(http_problem(400, "a header has a blank in its name"));
        }
        const auto [header, is_first] = request.headers.emplace(lower_case(name), value);
        if (!is_first) { // lines of one list (RFC 9110, 5.3)
            header->second.append(", ").append(value);
        }
    }
    if (count_of(head, "host") != 1) {
        return http_problem(400, "expected one header Host");
    }
    if (count_of(head, "content-length") > 1) {
        return http_problem(400, "expected at most one header Content-Length");
    }
    const auto target = path_and_query(head.target, request);
    if (!is_known_host(lower_case(request.header("host")), config)) {
        return http_problem(421, "the header Host names another server");
    }
    if (auto refusal = refused_method(request, config)) {
        return refusal;
    }
    if (auto refusal = refused_body(request, config)) {
        return refusal;
    }
    if (!parse_target(target, request)) {
        return http_problem(400, "the path or query is not percent-encoded text");
    }
    if (config.behind_proxy) { // the last address is the one that the proxy added
        const auto forwarded = request.header("x-forwarded-for");
        const auto comma = forwarded.rfind(',');
        const auto last =
            trimmed(comma == std::string_view::npos ? forwarded : forwarded.substr(comma + 1));
        request.client = last.empty() ? request.client : client_network(last);
    }
    return std::nullopt;
}

} // namespace macadam
