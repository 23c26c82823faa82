#include "app/database/period_options.hpp"

#include "app/database/time_border.hpp"

#include <fmt/format.h>

#include <string>

namespace macadam {
namespace {

std::optional<std::int64_t>
parse_border(const Arguments& arguments, std::string_view name, bool end) {
    const auto text = arguments.value(name);
    if (!text) {
        return std::nullopt;
    }
    const auto border = time_border_ms(*text, end);
    if (!border) {
        throw UsageError{fmt::format(
            "{} is '{}', expected a time such as 2026-03, 2026-03-01 or 2026-03-01T06:00:00Z",
            name,
            *text)};
    }
    return border;
}

} // namespace

std::optional<Period> parse_period(const Arguments& arguments) {
    const Period period{parse_border(arguments, "--since", false),
                        parse_border(arguments, "--until", true)};
    if (period.from_ms && period.until_ms && *period.from_ms >= *period.until_ms) {
        throw UsageError{fmt::format("--until is '{}', expected a time after --since '{}'",
                                     *arguments.value("--until"),
                                     *arguments.value("--since"))};
    }
    return period.from_ms || period.until_ms ? std::optional{period} : std::nullopt;
}

std::optional<std::int64_t> parse_begin(const Arguments& arguments, std::string_view name) {
    return parse_border(arguments, name, false);
}

} // namespace macadam
