#include "app/database/period_options.hpp"

#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace macadam {
namespace {

constexpr std::size_t month_letters = 7; // 2026-03
constexpr std::size_t day_letters = 10;  // 2026-03-01
constexpr std::int64_t day_ms = 86'400'000;

std::optional<std::int64_t> time_ms(const std::string& text) {
    const auto utc_s = parse_utc_s(text);
    return utc_s ? std::optional{std::llround(*utc_s * 1000)} : std::nullopt;
}

std::optional<std::int64_t> begin_of_day_ms(const std::string& day) {
    return time_ms(day + "T00:00:00Z");
}

/// Returns the month after a month such as "2026-03".
std::string month_after(const std::string& month) {
    const int year = std::stoi(month.substr(0, 4));
    const int number = std::stoi(month.substr(5));
    return number == 12 ? fmt::format("{:04}-01", year + 1)
                        : fmt::format("{:04}-{:02}", year, number + 1);
}

/// Returns the beginning or the end of the named month, day or time.
std::optional<std::int64_t> border_ms(const std::string& text, bool end) {
    if (text.size() == month_letters) {
        const auto begin = begin_of_day_ms(text + "-01");
        return end && begin ? begin_of_day_ms(month_after(text) + "-01") : begin;
    }
    if (text.size() == day_letters) {
        const auto begin = begin_of_day_ms(text);
        return end && begin ? std::optional{*begin + day_ms} : begin;
    }
    return time_ms(text);
}

std::optional<std::int64_t>
parse_border(const Arguments& arguments, std::string_view name, bool end) {
    const auto text = arguments.value(name);
    if (!text) {
        return std::nullopt;
    }
    const auto border = border_ms(*text, end);
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
