#include "mapping/fusion/utc_month.hpp"

namespace macadam {
namespace {

constexpr std::int64_t day_ms = 86'400'000;
constexpr std::int64_t days_of_era = 146'097; // 400 years

constexpr std::int64_t floored(std::int64_t value, std::int64_t by) {
    return value / by - (value % by < 0 ? 1 : 0);
}

/// Month counted from March of the year 0, so that a leap day ends its year.
///
/// Source: H. Hinnant, "chrono-Compatible Low-Level Date Algorithms" (2013), civil_from_days.
struct Month {
    std::int64_t year;
    std::int64_t number; ///< 0 = March
};

Month month_of(std::int64_t utc_ms) {
    const auto day = floored(utc_ms, day_ms) + 719'468; // since 0000-03-01
    const auto era = floored(day, days_of_era);
    const auto of_era = day - era * days_of_era;
    const auto year = (of_era - of_era / 1460 + of_era / 36'524 - of_era / (days_of_era - 1)) / 365;
    const auto of_year = of_era - (365 * year + year / 4 - year / 100);
    return {year + 400 * era, (5 * of_year + 2) / 153};
}

std::int64_t begin_of(const Month& month) {
    const auto era = floored(month.year, 400);
    const auto year = month.year - 400 * era;
    const auto of_year = (153 * month.number + 2) / 5;
    const auto day = era * days_of_era + 365 * year + year / 4 - year / 100 + of_year - 719'468;
    return day * day_ms;
}

} // namespace

std::int64_t month_begin_ms(std::int64_t utc_ms) {
    return begin_of(month_of(utc_ms));
}

std::int64_t next_month_ms(std::int64_t utc_ms) {
    auto [year, number] = month_of(utc_ms);
    const bool is_february = number == 11;
    return begin_of({is_february ? year + 1 : year, is_february ? 0 : number + 1});
}

} // namespace macadam
