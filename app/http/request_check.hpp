#pragma once

#include "app/http/http_message.hpp"
#include "app/http/http_server.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace macadam {

/// Head of a request as it came.
struct RequestHead {
    std::string_view method;
    std::string_view target;
    std::vector<std::pair<std::string_view, std::string_view>> headers;
};

/// Decodes a head, or returns the response that refuses it: targets and heads that are too large,
/// more than one Host or Content-Length, unknown hosts (a page of another site must not read this
/// server by a name of its own), methods and bodies that the configuration does not allow.
std::optional<HttpResponse>
decode_head(const RequestHead& head, const HttpServerConfig& config, HttpRequest& request);

/// Returns the stated length of the body; the largest number for what is no length.
std::uint64_t body_bytes_of(const HttpRequest& request);

} // namespace macadam
