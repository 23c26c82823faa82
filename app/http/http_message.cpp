#include "app/http/http_message.hpp"

#include "storage/text/json.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace macadam {
namespace {

int hex_digit(char letter) {
    return letter >= '0' && letter <= '9'   ? letter - '0'
           : letter >= 'a' && letter <= 'f' ? letter - 'a' + 10
           : letter >= 'A' && letter <= 'F' ? letter - 'A' + 10
                                            : -1;
}

std::int64_t modified_ns(const struct stat& status) {
    return status.st_mtim.tv_sec * std::int64_t{1'000'000'000} + status.st_mtim.tv_nsec;
}

} // namespace

HttpOpenFile::HttpOpenFile(const std::filesystem::path& path)
    : number_{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)} {
    struct stat status {};
    if (number_ >= 0 && fstat(number_, &status) == 0) {
        size_ = status.st_size;
        modified_ns_ = modified_ns(status);
    }
}

bool HttpOpenFile::is_unchanged() const {
    struct stat status {};
    return fstat(number_, &status) == 0 && status.st_size == size_ &&
           modified_ns(status) == modified_ns_;
}

HttpOpenFile::~HttpOpenFile() {
    if (number_ >= 0) {
        ::close(number_);
    }
}

std::optional<std::string> HttpRequest::parameter(std::string_view name) const {
    const auto found = std::ranges::find(
        parameters, name, [](const auto& pair) { return std::string_view{pair.first}; });
    return found == parameters.end() ? std::nullopt : std::optional{found->second};
}

std::string_view HttpRequest::header(std::string_view name) const {
    const auto found = headers.find(name);
    return found == headers.end() ? std::string_view{} : std::string_view{found->second};
}

std::string_view http_reason(int status) {
    switch (status) {
    case 400:
        return "Bad Request";
    case 401:
        return "Unauthorized";
    case 403:
        return "Forbidden";
    case 404:
        return "Not Found";
    case 405:
        return "Method Not Allowed";
    case 406:
        return "Not Acceptable";
    case 409:
        return "Conflict";
    case 410:
        return "Gone";
    case 411:
        return "Length Required";
    case 413:
        return "Content Too Large";
    case 414:
        return "URI Too Long";
    case 415:
        return "Unsupported Media Type";
    case 416:
        return "Range Not Satisfiable";
    case 421:
        return "Misdirected Request";
    case 422:
        return "Unprocessable Content";
    case 429:
        return "Too Many Requests";
    case 431:
        return "Request Header Fields Too Large";
    case 500:
        return "Internal Server Error";
    case 503:
        return "Service Unavailable";
    default:
        return "Error";
    }
}

HttpResponse http_problem(int status, std::string_view detail) {
    JsonObject problem;
    problem.add("title", std::string{http_reason(status)})
        .add("status", std::int64_t{status})
        .add("detail", std::string{detail});
    return {.status = status,
            .type = "application/problem+json",
            .body = problem.text() + "\n",
            .cache_control = "no-store"};
}

std::optional<std::string> percent_decoded(std::string_view text, bool plus_is_blank) {
    std::string decoded;
    for (std::size_t i = 0; i < text.size(); ++i) {
        char letter = text[i];
        if (letter == '%') {
            const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
            const int low = high < 0 ? -1 : hex_digit(text[i + 2]);
            if (low < 0) {
                return std::nullopt;
            }
            letter = static_cast<char>(high * 16 + low);
            i += 2;
        } else if (letter == '+' && plus_is_blank) {
            letter = ' ';
        }
        decoded += letter;
    }
    return decoded.find('\0') == std::string::npos ? std::optional{std::move(decoded)}
                                                   : std::nullopt;
}

std::string percent_encoded(std::string_view text) {
    constexpr std::string_view unreserved = "-._~";
    std::string encoded;
    for (const char letter : text) {
        const bool plain = (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
                           (letter >= 'A' && letter <= 'Z') ||
                           unreserved.find(letter) != std::string_view::npos;
        encoded += plain ? std::string{letter}
                         : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    return encoded;
}

bool parse_target(std::string_view target, HttpRequest& request) {
    const auto question = target.find('?');
    auto path = percent_decoded(target.substr(0, question), false);
    if (!path || !path->starts_with('/')) {
        return false;
    }
    request.path = *std::move(path);
    auto rest =
        question == std::string_view::npos ? std::string_view{} : target.substr(question + 1);
    while (!rest.empty()) {
        const auto word = rest.substr(0, rest.find('&'));
        rest.remove_prefix(std::min(word.size() + 1, rest.size()));
        if (word.empty()) {
            continue;
        }
        const auto equals = word.find('=');
        const auto name = percent_decoded(word.substr(0, equals), true);
        const auto value = equals == std::string_view::npos
                               ? std::optional{std::string{}}
                               : percent_decoded(word.substr(equals + 1), true);
        if (!name || !value) {
            return false;
        }
        request.parameters.emplace_back(*name, *value);
    }
    return true;
}

} // namespace macadam
