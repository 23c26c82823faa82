#pragma once

#include "app/http/compressed_files.hpp"
#include "app/http/http_message.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Part of a body or file.
struct BodyRange {
    std::uint64_t first;
    std::uint64_t size;
};

/// Parses the header Range: "bytes=0-499", "bytes=500-", "bytes=-500". \returns `std::nullopt` for
/// several ranges and what is no range, which are ignored (RFC 9110, 14.2); a size of 0 for a range
/// beyond the end.
std::optional<BodyRange> parse_range(std::string_view header, std::uint64_t size);

/// Response as it is sent.
struct FinishedResponse {
    int status;
    std::string body;
    std::optional<HttpFile> file;
    std::shared_ptr<HttpStream> stream;
    BodyRange part; ///< of the body or file
    std::vector<std::pair<std::string, std::string>> headers;
};

/// Applies what a request says of the form of its response: 304 if the client has it, gzip, a range
/// of it; and adds the headers that all responses have. What no cache may store is not compressed.
FinishedResponse finish(const HttpRequest& request, HttpResponse response, CompressedFiles& files);

} // namespace macadam
