#pragma once

#include "app/http/http_server.hpp"

#include <chrono>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>

namespace macadam::testing {

/// Configuration of a server on any port.
inline HttpServerConfig text_config() {
    return {.port = 0, .workers = 2};
}

/// Answers every path with a text; "/slow" and "/fails" as they say.
inline HttpHandlers text_handlers() {
    HttpHandlers made;
    made.answer = [](const HttpRequest& request, std::size_t) -> HttpResponse {
        if (request.path == "/slow") {
            std::this_thread::sleep_for(std::chrono::milliseconds{500});
        }
        if (request.path == "/fails") {
            throw std::runtime_error{"secret.gpkg is broken"};
        }
        if (request.path == "/own") {
            return {
                .type = "text/plain", .body = std::string(5000, 'a'), .cache_control = "no-store"};
        }
        return {.type = "text/plain", .body = std::string(5000, 'a'), .etag = "v1"};
    };
    made.answer_at_once = [](const HttpRequest& request) -> std::optional<HttpResponse> {
        return request.path == "/health" ? std::optional{HttpResponse{.body = "well"}}
                                         : std::nullopt;
    };
    return made;
}

/// Head of a request with the status by which it is refused.
struct RefusedHead {
    std::string_view head;
    int status;
};

} // namespace macadam::testing
