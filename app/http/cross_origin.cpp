#include "app/http/cross_origin.hpp"

#include <algorithm>

namespace macadam {
namespace {

bool allows_any(std::span<const std::string> allowed) {
    return std::ranges::find(allowed, "*") != allowed.end();
}

bool allows(std::span<const std::string> allowed, std::string_view origin) {
    return !origin.empty() &&
           (allows_any(allowed) || std::ranges::find(allowed, origin) != allowed.end());
}

} // namespace

bool is_origin(std::string_view text) {
    constexpr std::string_view of_host = "abcdefghijklmnopqrstuvwxyz0123456789.-_:[]";
    const auto scheme = text.starts_with("https://")  ? std::string_view{"https://"}
                        : text.starts_with("http://") ? std::string_view{"http://"}
                                                      : std::string_view{};
    const auto host = text.substr(scheme.size());
    return text == "*" || (!scheme.empty() && !host.empty() &&
                           host.find_first_not_of(of_host) == std::string_view::npos);
}

HeaderLines cross_origin_headers(std::span<const std::string> allowed, std::string_view origin) {
    HeaderLines headers;
    if (allowed.empty()) {
        return headers;
    }
    if (!allows_any(allowed)) {
        headers.emplace_back("Vary", "Origin");
    }
    if (allows_any(allowed) || allows(allowed, origin)) {
        headers.emplace_back("Access-Control-Allow-Origin", allows_any(allowed) ? "*" : origin);
        headers.emplace_back("Access-Control-Expose-Headers", "ETag, Link, Content-Range");
    }
    return headers;
}

HeaderLines preflight_headers(std::span<const std::string> allowed, std::string_view origin) {
    if (!allows(allowed, origin)) {
        return {};
    }
    const bool is_any = allows_any(allowed);
    HeaderLines headers{{"Access-Control-Allow-Origin", std::string{is_any ? "*" : origin}},
                        {"Access-Control-Allow-Methods", "GET, HEAD"},
                        {"Access-Control-Allow-Headers",
                         is_any ? "If-None-Match, Range" : "Authorization, If-None-Match, Range"},
                        {"Access-Control-Max-Age", "3600"}};
    if (!is_any) {
        headers.emplace_back("Vary", "Origin");
    }
    return headers;
}

} // namespace macadam
