#include "app/terminal/text_style.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include <unistd.h>

namespace macadam {
namespace {

/// Returns a variable of the environment; "" if it is not set.
std::string_view variable(const char* name) {
    const char* const value = std::getenv(name); // NOLINT(concurrency-mt-unsafe): nothing sets it
    return value == nullptr ? "" : value;
}

std::string_view sequence_of(TextStyle style) {
    switch (style) {
    case TextStyle::heading:
        return "1";
    case TextStyle::good:
        return "32";
    case TextStyle::warning:
        return "33";
    case TextStyle::error:
        break;
    }
    return "31";
}

} // namespace

bool is_coloured(int stream) {
    if (!variable("NO_COLOR").empty()) {
        return false;
    }
    const auto force = variable("CLICOLOR_FORCE");
    if (!force.empty() && force != "0") {
        return true;
    }
    return isatty(stream) == 1 && variable("TERM") != "dumb";
}

std::string styled(TextStyle style, std::string_view text, int stream) {
    return is_coloured(stream) && !text.empty()
               ? fmt::format("\033[{}m{}\033[0m", sequence_of(style), text)
               : std::string{text};
}

} // namespace macadam
