#include "storage/text/utc.hpp"

#include <fmt/format.h>

#include <charconv>
#include <chrono>

namespace macadam {
namespace {

namespace chr = std::chrono;

/// Removes a number of `digits` digits from the front of `text`.
std::optional<int> take_number(std::string_view& text, std::size_t digits) {
    int number = 0;
    if (text.size() < digits) {
        return std::nullopt;
    }
    const auto [stop, error] = std::from_chars(text.data(), text.data() + digits, number);
    if (error != std::errc{} || stop != text.data() + digits || number < 0) {
        return std::nullopt;
    }
    text.remove_prefix(digits);
    return number;
}

bool take(std::string_view& text, char expected) {
    if (!text.starts_with(expected)) {
        return false;
    }
    text.remove_prefix(1);
    return true;
}

/// Removes a fraction such as ".225"; 0 if there is none.
std::optional<double> take_fraction(std::string_view& text) {
    if (!text.starts_with('.')) {
        return 0.0;
    }
    double fraction = 0;
    const auto [stop, error] =
        std::from_chars(text.data(), text.data() + text.size(), fraction, std::chars_format::fixed);
    const auto taken = static_cast<std::size_t>(stop - text.data());
    if (error != std::errc{} || taken < 2) {
        return std::nullopt;
    }
    text.remove_prefix(taken);
    return fraction;
}

/// Writes a number with leading zeros; optimised, because a database contains millions of times.
void put(char* text, std::int64_t number, int digits) {
    for (char* place = text + digits; place > text; number /= 10) {
        *--place = static_cast<char>('0' + number % 10);
    }
}

} // namespace

std::string utc_text(std::int64_t utc_ms) {
    const chr::sys_time<chr::milliseconds> time{chr::milliseconds{utc_ms}};
    const auto day = chr::floor<chr::days>(time);
    const chr::year_month_day date{day};
    const chr::hh_mm_ss clock{time - day};
    const auto year = static_cast<int>(date.year());
    std::string text =
        year >= 0 && year <= 9999 ? std::string{"0000"} : std::string{fmt::format_int{year}.str()};
    if (text == "0000") {
        put(text.data(), year, 4);
    }
    const auto after_year = text.size();
    text += "-00-00T00:00:00";
    char* const rest = text.data() + after_year;
    put(rest + 1, static_cast<unsigned>(date.month()), 2);
    put(rest + 4, static_cast<unsigned>(date.day()), 2);
    put(rest + 7, clock.hours().count(), 2);
    put(rest + 10, clock.minutes().count(), 2);
    put(rest + 13, clock.seconds().count(), 2);
    if (const auto ms = clock.subseconds().count(); ms != 0) {
        text += ".000";
        put(text.data() + text.size() - 3, ms, 3);
    }
    text += 'Z';
    return text;
}

std::string utc_day(std::int64_t utc_ms) {
    const auto text = utc_text(utc_ms);
    return text.substr(0, text.find('T'));
}

std::optional<double> parse_utc_s(std::string_view text) {
    const auto year = take_number(text, 4);
    const bool dash = take(text, '-');
    const auto month = take_number(text, 2);
    const bool second_dash = take(text, '-');
    const auto day = take_number(text, 2);
    const bool t = take(text, 'T') || take(text, ' ');
    const auto hour = take_number(text, 2);
    const bool colon = take(text, ':');
    const auto minute = take_number(text, 2);
    const bool second_colon = take(text, ':');
    const auto second = take_number(text, 2);
    const auto fraction = take_fraction(text);
    if (!(dash && second_dash && t && colon && second_colon && year && month && day && hour &&
          minute && second && fraction && text == "Z")) {
        return std::nullopt;
    }
    const chr::year_month_day date{chr::year{*year},
                                   chr::month{static_cast<unsigned>(*month)},
                                   chr::day{static_cast<unsigned>(*day)}};
    if (!date.ok() || *hour > 23 || *minute > 59 || *second > 60) {
        return std::nullopt;
    }
    const auto days = chr::sys_days{date}.time_since_epoch().count();
    return 86400.0 * static_cast<double>(days) + 3600.0 * *hour + 60.0 * *minute + *second +
           *fraction;
}

} // namespace macadam
