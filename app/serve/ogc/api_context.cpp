#include "app/serve/ogc/api_context.hpp"

#include "app/cli/arguments.hpp"
#include "storage/files/sha256.hpp"
#include "storage/text/json.hpp"
#include "storage/text/text.hpp"
#include "storage/text/xml_escape.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace macadam {
namespace {

/// Returns whether a browser asks, which takes HTML before JSON.
bool wants_html(const HttpRequest& request) {
    if (const auto format = request.parameter("f")) {
        if (*format != "html" && *format != "json") {
            throw UsageError{fmt::format("f is {}, expected json or html", in_quotes(*format))};
        }
        return *format == "html";
    }
    const auto accept = request.header("accept");
    return accept.find("text/html") < accept.find("json");
}

/// Escapes JSON for HTML, with its addresses as links.
std::string linked_text(std::string_view json) {
    std::string html;
    while (!json.empty()) {
        const auto begin = json.find("\"http");
        html += xml_text(json.substr(0, begin));
        if (begin == std::string_view::npos) {
            break;
        }
        json.remove_prefix(begin + 1);
        const auto address = json.substr(0, json.find('"'));
        html += fmt::format("\"<a href=\"{0}\">{0}</a>", xml_text(address));
        json.remove_prefix(address.size());
    }
    return html;
}

/// Breaks JSON into lines at the members of the outer levels, for reading.
std::string in_lines(std::string_view json) {
    std::string lines;
    std::size_t depth = 0;
    bool in_text = false, escaped = false;
    constexpr std::size_t max_depth = 4; // deeper values stay on one line
    const auto next_line = [&] {
        lines += '\n';
        lines.append(2 * depth, ' ');
    };
    for (const char letter : json) {
        const bool closes = !in_text && (letter == '}' || letter == ']');
        if (closes && depth-- <= max_depth) {
            next_line();
        }
        lines += letter;
        if (!in_text && (letter == '{' || letter == '[') && ++depth <= max_depth) {
            next_line();
        }
        if (!in_text && letter == ',' && depth <= max_depth) {
            next_line();
        }
        in_text = letter == '"' && !escaped ? !in_text : in_text;
        escaped = letter == '\\' && !escaped;
    }
    return lines;
}

std::string html_page(std::string_view title, std::string_view json) {
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
        "<meta name=\"viewport\" content=\"width=device-width\">"
        "<link rel=\"icon\" href=\"data:,\">" // none, rather than a search for /favicon.ico
        "<title>{0}</title></head>\n<body><h1>{0}</h1>\n<pre>{1}</pre></body></html>\n",
        xml_text(title),
        linked_text(in_lines(json)));
}

} // namespace

std::string links_text(const std::vector<ApiLink>& links) {
    std::vector<std::string> texts;
    for (const auto& [href, rel, type, title] : links) {
        JsonObject link;
        link.add("href", href).add("rel", std::string{rel}).add("type", std::string{type});
        if (!title.empty()) {
            link.add("title", title);
        }
        texts.push_back(link.text());
    }
    return json_array(texts);
}

HttpResponse
api_page(const ApiContext& context, std::string title, std::string json, std::string_view type) {
    const bool is_html = wants_html(context.request);
    Sha256 hash;
    for (const std::string_view part : {context.version, context.base, context.request.path}) {
        hash.add(part);
        hash.add("\n");
    }
    for (const auto& [name, value] : context.request.parameters) {
        hash.add(name + "=" + value + "\n");
    }
    constexpr std::size_t letters = 16;
    if (is_html) {
        json = html_page(title, json);
    } else {
        json += '\n';
    }
    HttpResponse response{.type = is_html ? "text/html; charset=utf-8" : std::string{type},
                          .body = std::move(json),
                          .etag = hash.hex().substr(0, letters) + (is_html ? "h" : "j")};
    response.headers.emplace_back("Vary", "Accept");
    return response;
}

void expect_single(const HttpRequest& request) {
    std::set<std::string_view> names;
    for (const auto& [name, value] : request.parameters) {
        if (!names.insert(name).second) {
            throw UsageError{fmt::format("parameter {} is given twice", in_quotes(name))};
        }
    }
}

void expect_parameters(const HttpRequest& request, const std::vector<std::string_view>& known) {
    expect_single(request);
    for (const auto& [name, value] : request.parameters) {
        if (name != "f" && std::ranges::find(known, name) == known.end()) {
            throw UsageError{fmt::format("unknown parameter {}", in_quotes(name))};
        }
    }
}

} // namespace macadam
