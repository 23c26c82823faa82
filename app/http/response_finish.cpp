#include "app/http/response_finish.hpp"

#include "estimator/common/ascii.hpp"
#include "storage/files/gzip.hpp"
#include "storage/text/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <iterator>

namespace macadam {
namespace {

/// Sources from which pages may load: their own scripts, styles, fonts and data alone.
constexpr std::string_view content_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; worker-src 'self'; "
    "img-src 'self' data: blob:; font-src 'self'; connect-src 'self'; manifest-src 'self'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'none'";

constexpr std::size_t least_compressed = 1024; // bytes; below, gzip gains less than a packet

/// Calls `visit` with each element of a list of a header, without blanks, until it returns true.
template <typename Visit>
bool any_element(std::string_view list, const Visit& visit) {
    while (!list.empty()) {
        const auto element = list.substr(0, list.find(','));
        list.remove_prefix(std::min(element.size() + 1, list.size()));
        if (visit(trimmed(element))) {
            return true;
        }
    }
    return false;
}

/// Tests whether a client takes gzip: named, or else by *, without q=0.
bool takes_gzip(std::string_view accept_encoding) {
    std::optional<double> named, any;
    any_element(accept_encoding, [&](std::string_view element) {
        const auto semicolon = element.find(';');
        const auto name = in_lower_case(trimmed(element.substr(0, semicolon)));
        const auto rest = semicolon == std::string_view::npos ? std::string_view{}
                                                              : element.substr(semicolon + 1);
        const auto equals = rest.find('=');
        const auto weight = equals == std::string_view::npos
                                ? std::optional{1.0}
                                : parse_number(rest.substr(equals + 1));
        if (name == "gzip") {
            named = weight.value_or(0);
        } else if (name == "*") {
            any = weight.value_or(0);
        }
        return false;
    });
    return named.value_or(any.value_or(0)) > 0;
}

/// Tests whether a client has a response: weak comparison, as RFC 9110, 13.1.2 asks.
bool has_match(std::string_view if_none_match, std::string_view quoted) {
    return any_element(if_none_match, [&](std::string_view element) {
        if (element.starts_with("W/")) {
            element.remove_prefix(2);
        }
        return element == "*" || element == quoted;
    });
}

bool is_compressible(std::string_view type) {
    constexpr std::array<std::string_view, 7> kinds{
        "text/", "json", "javascript", "xml", "svg", "openapi", "vector-tile"};
    return std::ranges::any_of(
        kinds, [&](std::string_view kind) { return type.find(kind) != std::string_view::npos; });
}

std::optional<std::uint64_t> parse_whole(std::string_view text) {
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc{} && end == text.data() + text.size() ? std::optional{value}
                                                                    : std::nullopt;
}

/// Tests whether a response is sent in gzip.
bool is_sent_gzipped(const HttpRequest& request, const HttpResponse& response) {
    // The size of what one client alone may see would tell of its content, to who makes his browser
    // ask for it (BREACH, CVE-2013-3587).
    const bool is_for_one = response.cache_control == "no-store";
    if (is_for_one || !takes_gzip(request.header("accept-encoding"))) {
        return false;
    }
    if (response.is_gzipped || !is_compressible(response.type) ||
        !request.header("range").empty()) {
        return response.is_gzipped;
    }
    return response.file ? response.file->size >= least_compressed && !response.etag.empty() &&
                               response.file->size <= CompressedFiles::max_file_bytes
                         : response.body.size() >= least_compressed;
}

/// Compresses a response, or decompresses one, as the client takes it.
void encode(const HttpRequest& request, HttpResponse& response, CompressedFiles& files) {
    const bool was_gzipped = response.is_gzipped;
    response.is_gzipped = is_sent_gzipped(request, response);
    if (was_gzipped == response.is_gzipped) {
        return;
    }
    if (was_gzipped) {
        response.body = gunzipped(response.body);
    } else if (!response.file) {
        response.body = gzipped(response.body, GzipUse::sent_once);
    } else if (const auto bytes = files.get(response.etag, *response.file)) {
        response.body = *bytes;
        response.file.reset();
    } else {
        response.is_gzipped = false;
    }
}

/// Text of the header ETag. That of a response in gzip is weak: its bytes are others (RFC 9110,
/// 8.8.3.3).
std::string quoted_etag(const HttpResponse& response) {
    return fmt::format("{}\"{}\"", response.is_gzipped ? "W/" : "", response.etag);
}

void add_common_headers(const HttpResponse& response,
                        std::vector<std::pair<std::string, std::string>>& headers) {
    const auto add = [&](std::string_view name, std::string_view value) {
        headers.emplace_back(name, value);
    };
    if (response.status != 204 && response.status != 304) {
        add("Content-Type", response.type);
    }
    if (!response.etag.empty()) {
        add("ETag", quoted_etag(response));
    }
    add("Cache-Control", response.cache_control);
    add("X-Content-Type-Options", "nosniff");
    add("Content-Security-Policy", content_policy);
    add("Referrer-Policy", "no-referrer");
    if (response.is_gzipped && response.status == 200) {
        add("Content-Encoding", "gzip");
    }
}

} // namespace

std::optional<BodyRange> parse_range(std::string_view header, std::uint64_t size) {
    constexpr std::string_view unit = "bytes=";
    if (!header.starts_with(unit)) {
        return std::nullopt;
    }
    const auto range = trimmed(header.substr(unit.size()));
    const auto dash = range.find('-');
    if (dash == std::string_view::npos) {
        return std::nullopt;
    }
    const auto first = parse_whole(range.substr(0, dash));
    const auto last = parse_whole(range.substr(dash + 1));
    if (dash == 0) { // the last bytes
        return !last
                   ? std::nullopt
                   : std::optional{BodyRange{size - std::min(*last, size), std::min(*last, size)}};
    }
    if (!first || (!last && dash + 1 != range.size()) || (last && *last < *first)) {
        return std::nullopt;
    }
    if (*first >= size) {
        return BodyRange{size, 0};
    }
    const auto end = last ? std::min(*last, size - 1) : size - 1;
    return BodyRange{*first, end - *first + 1};
}

FinishedResponse finish(const HttpRequest& request, HttpResponse response, CompressedFiles& files) {
    if (response.status == 200 && (response.is_gzipped || is_compressible(response.type))) {
        response.headers.emplace_back("Vary", "Accept-Encoding");
    }
    if (response.status == 200 && !response.etag.empty() &&
        has_match(request.header("if-none-match"), fmt::format("\"{}\"", response.etag))) {
        response.status = 304;
        response.is_gzipped = is_sent_gzipped(request, response); // for its ETag
        response.body.clear();
        response.file.reset();
    } else if (response.status == 200) {
        encode(request, response, files);
    }
    FinishedResponse finished{
        .status = response.status, .body = {}, .file = {}, .stream = {}, .part = {}, .headers = {}};
    const auto size = response.file ? response.file->size : response.body.size();
    finished.part = {0, size};
    if (const auto asked = request.header("range"); response.status == 200 && response.file) {
        finished.headers.emplace_back("Accept-Ranges", "bytes");
        const auto if_range = request.header("if-range");
        const bool is_same = if_range.empty() || if_range == fmt::format("\"{}\"", response.etag);
        const bool is_head = request.method == "HEAD"; // ranges are for GET (RFC 9110, 14.2)
        if (const auto range = parse_range(asked, size); range && is_same && !is_head) {
            finished.part = *range;
            finished.status = range->size == 0 ? 416 : 206;
            finished.headers.emplace_back(
                "Content-Range",
                range->size == 0
                    ? fmt::format("bytes */{}", size)
                    : fmt::format(
                          "bytes {}-{}/{}", range->first, range->first + range->size - 1, size));
        }
    }
    add_common_headers(response, finished.headers);
    std::ranges::move(response.headers, std::back_inserter(finished.headers));
    finished.body = std::move(response.body);
    finished.file = std::move(response.file);
    finished.stream = std::move(response.stream);
    return finished;
}

} // namespace macadam
