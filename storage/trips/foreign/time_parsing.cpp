#include "storage/trips/foreign/time_parsing.hpp"

#include "storage/text/text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <chrono>
#include <cmath>
#include <string>

namespace macadam {

namespace {

namespace chr = std::chrono;

constexpr double minute_s = 60;
constexpr double hour_s = 3600;
constexpr double day_s = 86400;
constexpr std::size_t max_digits = 9; // per component of a date or time

// Plausible years of a car's log; loggers without a date write year 1, 1970 or 1980.
constexpr int first_year = 1990;
constexpr int last_year = 2099;

struct Digits {
    int number;
    std::size_t count;
};

/// Removes a whole number from the front of `text`.
std::optional<Digits> take_digits(std::string_view& text) {
    int number = 0;
    const auto shown = text.substr(0, max_digits);
    const auto [stop, error] = std::from_chars(shown.data(), shown.data() + shown.size(), number);
    const auto count = static_cast<std::size_t>(stop - shown.data());
    if (error != std::errc{} || count == 0 || shown.front() == '-') {
        return std::nullopt;
    }
    text.remove_prefix(count);
    return Digits{number, count};
}

bool take_one_of(std::string_view& text, std::string_view letters) {
    if (text.empty() || letters.find(text.front()) == std::string_view::npos) {
        return false;
    }
    text.remove_prefix(1);
    return true;
}

/// Removes a month from the front: its number, or the first letters of its English, German or
/// French name.
std::optional<int> take_month(std::string_view& text) {
    constexpr std::size_t letters = 3;
    constexpr std::array<std::string_view, 12> names{"jan",
                                                     "feb fév",
                                                     "mar mär mrz",
                                                     "apr avr",
                                                     "may mai",
                                                     "jun",
                                                     "jul",
                                                     "aug aoû",
                                                     "sep",
                                                     "oct okt",
                                                     "nov",
                                                     "dec dez déc"};
    if (const auto digits = take_digits(text)) {
        return digits->number;
    }
    std::string begin;
    std::size_t end = 0;
    while (end < text.size() && (std::isalpha(static_cast<unsigned char>(text[end])) != 0 ||
                                 static_cast<unsigned char>(text[end]) >= 0x80)) {
        begin += static_cast<char>(std::tolower(static_cast<unsigned char>(text[end++])));
    }
    if (begin.size() < letters) {
        return std::nullopt;
    }
    for (std::size_t month = 0; month < names.size(); ++month) {
        for (auto rest = names[month]; !rest.empty();) {
            const auto name = rest.substr(0, rest.find(' '));
            if (begin.starts_with(name)) {
                text.remove_prefix(end);
                return static_cast<int>(month) + 1;
            }
            rest.remove_prefix(std::min(rest.size(), name.size() + 1));
        }
    }
    return std::nullopt;
}

/// Removes AM or PM from the front: seconds to add to the time of a 12-hour clock.
double take_half_of_day(std::string_view& text, double clock_s) {
    constexpr double half_day_s = day_s / 2;
    const auto second = text.substr(0, 2);
    const bool is_am = second == "AM" || second == "am";
    const bool is_pm = second == "PM" || second == "pm";
    if (!is_am && !is_pm) {
        return 0;
    }
    text.remove_prefix(2);
    const bool is_twelve = clock_s >= half_day_s;
    return is_am ? (is_twelve ? -half_day_s : 0) : (is_twelve ? 0 : half_day_s);
}

/// Fraction of a second: decimals, or a count of `unit_s`.
double fraction_of(const Digits& digits, const std::optional<double>& unit_s) {
    return unit_s ? digits.number * *unit_s
                  : digits.number / std::pow(10.0, static_cast<double>(digits.count));
}

/// Removes hh:mm[:ss[.f]] from the front; the fraction may also follow a colon or a comma.
std::optional<double> take_clock(std::string_view& text, const std::optional<double>& unit_s) {
    const auto hour = take_digits(text);
    const bool colon = take_one_of(text, ":");
    const auto minute = take_digits(text);
    if (!hour || !colon || !minute || hour->number > 23 || minute->number > 59) {
        return std::nullopt;
    }
    double time_s = hour->number * hour_s + minute->number * minute_s;
    if (take_one_of(text, ":")) {
        const auto second = take_digits(text);
        if (!second || second->number > 60) {
            return std::nullopt;
        }
        time_s += second->number;
        if (take_one_of(text, ".,:")) {
            const auto fraction = take_digits(text);
            if (!fraction) {
                return std::nullopt;
            }
            time_s += fraction_of(*fraction, unit_s);
            while (take_one_of(text, "0123456789")) { // finer than a nanosecond
            }
        }
    }
    return time_s;
}

/// Removes Z, +hh:mm, +hhmm or +hh from the front: local time minus UTC.
std::optional<double> take_zone(std::string_view& text) {
    if (take_one_of(text, "Zz")) {
        return 0.0;
    }
    const double sign = text.starts_with('-') ? -1 : 1;
    if (!take_one_of(text, "+-")) {
        return std::nullopt;
    }
    const auto hours = take_digits(text);
    if (!hours) {
        return std::nullopt;
    }
    if (hours->count > 2) {
        return sign * (hours->number / 100 * hour_s + hours->number % 100 * minute_s);
    }
    const auto minutes = take_one_of(text, ":") ? take_digits(text) : std::nullopt;
    return sign * (hours->number * hour_s + (minutes ? minutes->number * minute_s : 0));
}

std::optional<double> days_of(const std::array<int, 3>& parts, TimeFormat format) {
    auto [year, month, day] = parts;
    if (format != TimeFormat::year_month_day) {
        year = parts[2];
        month = parts[format == TimeFormat::day_month_year ? 1 : 0];
        day = parts[format == TimeFormat::day_month_year ? 0 : 1];
    }
    const chr::year_month_day date{chr::year{year},
                                   chr::month{static_cast<unsigned>(month)},
                                   chr::day{static_cast<unsigned>(day)}};
    if (!date.ok() || year < first_year || year > last_year) {
        return std::nullopt;
    }
    return static_cast<double>(chr::sys_days{date}.time_since_epoch().count());
}

std::optional<ReadTime> dated_time(std::string_view text, const TimeMapping& mapping) {
    std::array<int, 3> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const auto number = take_month(text);
        if (!number || (i < 2 && !take_one_of(text, "/.- "))) {
            return std::nullopt;
        }
        parts[i] = *number;
    }
    const auto days = days_of(parts, mapping.format);
    if (!days || !take_one_of(text, "Tt ")) {
        return std::nullopt;
    }
    text = trimmed(text);
    auto clock_s = take_clock(text, mapping.fraction_s);
    text = trimmed(text);
    clock_s = clock_s ? *clock_s + take_half_of_day(text, *clock_s) : clock_s;
    text = trimmed(text);
    const auto zone_s = text.empty() ? mapping.utc_offset_s : take_zone(text);
    if (!clock_s || !text.empty()) {
        return std::nullopt;
    }
    return ReadTime{*days * day_s + *clock_s - zone_s.value_or(0), zone_s.has_value()};
}

std::optional<ReadTime> clock_time(std::string_view text, const TimeMapping& mapping) {
    const auto clock_s = take_clock(text, mapping.fraction_s);
    if (!clock_s || !text.empty()) {
        return std::nullopt;
    }
    return ReadTime{*clock_s, false};
}

/// Parses a time such as 81530.5, which is 8:15:30.5.
std::optional<ReadTime> compact_time(std::string_view text) {
    const auto number = parse_number(text);
    if (!number || !(*number >= 0 && *number < 240000)) {
        return std::nullopt;
    }
    const double hours = std::floor(*number / 10000);
    const double minutes = std::floor((*number - hours * 10000) / 100);
    const double seconds = *number - hours * 10000 - minutes * 100;
    if (minutes >= 60 || seconds >= 61) {
        return std::nullopt;
    }
    return ReadTime{hours * hour_s + minutes * minute_s + seconds, false};
}

} // namespace

std::optional<ReadTime> parse_time(std::string_view text, const TimeMapping& mapping) {
    text = trimmed(text);
    switch (mapping.format) {
    case TimeFormat::number:
        if (const auto number = parse_number(text); number && std::isfinite(*number)) {
            return ReadTime{*number * mapping.unit_s, mapping.since_1970};
        }
        return std::nullopt;
    case TimeFormat::clock:
        return clock_time(text, mapping);
    case TimeFormat::compact_clock:
        return compact_time(text);
    case TimeFormat::day_month_year:
    case TimeFormat::month_day_year:
    case TimeFormat::year_month_day:
        return dated_time(text, mapping);
    }
    return std::nullopt;
}

} // namespace macadam
