#include "app/database/time_border.hpp"

#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <cmath>

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

} // namespace

std::optional<std::int64_t> time_border_ms(const std::string& text, bool end) {
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

} // namespace macadam
