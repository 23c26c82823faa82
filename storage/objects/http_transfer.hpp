#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <stop_token>
#include <string>
#include <string_view>
#include <vector>

namespace macadam {

/// HTTP request, with what becomes of its body and answer.
struct HttpTransfer {
    std::string method; ///< GET, PUT or DELETE
    std::string url;
    std::vector<std::string> headers; ///< "name: value"

    /// Body of a PUT, in blocks: fills the front of the span. May throw.
    std::function<std::size_t(std::span<char>)> body{};
    std::int64_t body_bytes = 0;

    /// Receives the body of an answer 2xx in blocks; false if no more is wanted. May throw.
    std::function<bool(std::string_view)> receive{};
    std::int64_t most_bytes = 0; ///< expected in the answer, for the time limit

    std::stop_token stop{};
};

/// Answer, or why there is none.
struct HttpOutcome {
    long status = 0;       ///< 0: none
    std::string failure;   ///< "" for an answer
    bool is_final = false; ///< trying again cannot help: an untrusted certificate
    std::string words;     ///< the first KiB of the body of an error
};

/// Runs one transfer by libcurl: certificates are verified, redirects are not followed. It ends
/// after 10 s without a connection, 30 s of less than 1 KiB/s, or 60 s and 1 s for each 64 KiB.
/// Exceptions of the callbacks are thrown again.
using HttpRun = void(const HttpTransfer& transfer, HttpOutcome& outcome);
inline constexpr const char* http_run_name = "macadam_http_run";

} // namespace macadam
