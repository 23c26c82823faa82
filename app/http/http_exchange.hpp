#pragma once

#include "app/http/http_message.hpp"
#include "app/http/response_finish.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace macadam {

/// Request with its response, from its first line until the response is sent.
struct HttpExchange {
    using Clock = std::chrono::steady_clock;

    explicit HttpExchange(std::string its_target) : target{std::move(its_target)} {}

    std::string target;
    HttpRequest request{};
    FinishedResponse response{};
    std::string_view route{}; ///< of the response
    Clock::time_point begin = Clock::now();
    bool is_read = false; ///< whole
    std::optional<HttpResponse> refusal{};
    std::uint64_t body_bytes = 0; ///< that are to be read before an answer
    std::uint64_t received_bytes = 0;
    std::string pending{};        ///< received, and not yet handed on
    Clock::duration handing_on{}; ///< time for which the client had to wait for us
    std::size_t lane = 0;
    bool is_begun = false;
    bool is_counted = false;           ///< among the requests of its client
    bool is_in_lane = false;           ///< among those of its client in the lane
    std::atomic<bool> is_done = false; ///< by the worker
    std::uint64_t unread_bytes = 0;
};

} // namespace macadam
