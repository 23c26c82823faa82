#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace macadam {

/// Header lines of a response.
using HeaderLines = std::vector<std::pair<std::string, std::string>>;

// Pages of other sites that may read answers (CORS; Fetch Standard, 3.3).
//
// `allowed` are origins in lower case, such as "https://maps.example.org"; {"*"} = any; empty =
// none. With "*" no page may send a token.

/// Tests for an origin as browsers send it: scheme and host, with its port unless it is the usual
/// one, in lower case, without a path; or "*".
bool is_origin(std::string_view text);

/// Headers that let a page of `origin` read an answer. Where origins are listed, there is a Vary
/// for all others, too.
HeaderLines cross_origin_headers(std::span<const std::string> allowed, std::string_view origin);

/// Headers of the answer to a preflight request; empty if its origin is not allowed.
HeaderLines preflight_headers(std::span<const std::string> allowed, std::string_view origin);

} // namespace macadam
