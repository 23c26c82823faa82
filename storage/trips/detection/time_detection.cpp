#include "storage/trips/detection/time_detection.hpp"

#include "storage/text/text.hpp"
#include "storage/trips/foreign/time_parsing.hpp"
#include "storage/trips/mappings/unit_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

// Of consecutive rows: times that never rise are none; one clock may stand for several rows.
constexpr double max_falling_share = 0.01;
constexpr double min_rising_share = 0.05;
constexpr double fine_rising_share = 0.9;

// Steps between rows of a log, s.
constexpr double shortest_step_s = 2e-4;
constexpr double longest_step_s = 10;
constexpr double longest_epoch_step_s = 2; // a count of ms after a week of running is no date

struct NumberUnit {
    std::string_view word;
    double unit_s;
};
constexpr std::array<NumberUnit, 4> number_units{
    NumberUnit{"s", 1}, NumberUnit{"ms", 1e-3}, NumberUnit{"us", 1e-6}, NumberUnit{"ns", 1e-9}};

// Seconds since 1970 from 2008 to 2100. Counts since 1980 (GPS) or 2001 (Apple) would be dates
// before, until 2008 comes up in them.
constexpr double earliest_s = 1199145600;
constexpr double latest_s = 4102444800;

struct TextFormat {
    std::string_view word;
    TimeFormat format;
};
constexpr std::array<TextFormat, 4> text_formats{
    TextFormat{"iso", TimeFormat::year_month_day},
    TextFormat{"dd/mm/yyyy hh:mm:ss", TimeFormat::day_month_year},
    TextFormat{"mm/dd/yyyy hh:mm:ss", TimeFormat::month_day_year},
    TextFormat{"hh:mm:ss", TimeFormat::clock}};

/// Steps of a time from row to row.
struct Steps {
    double rising = 0; ///< share
    double falling = 0;
    double median_s = unknown; ///< of those that rise
};

Steps steps_of(const std::vector<double>& t_s) {
    std::vector<double> rises;
    std::size_t falls = 0;
    std::size_t count = 0;
    double last = unknown;
    for (const double t : t_s) {
        if (std::isnan(t)) {
            continue;
        }
        if (!std::isnan(last)) {
            ++count;
            falls += t < last ? 1U : 0U;
            if (t > last) {
                rises.push_back(t - last);
            }
        }
        last = t;
    }
    if (count == 0) {
        return {};
    }
    const auto all = static_cast<double>(count);
    return {.rising = static_cast<double>(rises.size()) / all,
            .falling = static_cast<double>(falls) / all,
            .median_s = known_median(std::move(rises))};
}

bool is_like_time(const Steps& steps) {
    return steps.rising >= min_rising_share && steps.falling <= max_falling_share;
}

std::vector<double> scaled(std::vector<double> values, double factor) {
    for (auto& value : values) {
        value *= factor;
    }
    return values;
}

/// Unit of a count by its steps, as rows come at 0.5 to 1000 Hz. It is a guess but for small steps
/// with decimals, which are seconds.
NumberUnit unit_by_steps(double step, bool whole) {
    if (!whole) {
        return number_units[step >= 5 ? 1 : 0]; // 5.03 ms, not 5.03 s
    }
    return number_units[step <= 1 ? 0 : step <= 1500 ? 1 : step < 2e5 ? 2 : 3];
}

/// Reads a column as hhmmss, if all its values are such.
std::optional<DetectedTime> as_compact_clock(const LogColumn& column) {
    TimeMapping mapping;
    mapping.format = TimeFormat::compact_clock;
    DetectedTime time{.columns = {column.number},
                      .format = "hhmmss",
                      .confidence = Confidence::likely,
                      .reason = "all values are times of day"};
    bool rolls_over = false; // a minute that ends after 59
    double last = unknown;
    for (const double value : column.values) {
        const auto read = std::isnan(value) ? std::optional{ReadTime{unknown, false}}
                                            : parse_time(fmt::format("{}", value), mapping);
        if (!read) {
            return std::nullopt;
        }
        rolls_over = rolls_over || (value - last > 40 && value - last < 4100);
        last = std::isnan(value) ? last : value;
        time.t_s.push_back(read->s);
    }
    const bool may_be = known_median(column.values) >= 10000 && column.named.unit.empty();
    if (!may_be || !rolls_over) {
        return std::nullopt;
    }
    time.confidence = Confidence::sure;
    return time;
}

DetectedTime as_epoch(const LogColumn& column, const NumberUnit& unit) {
    return {.columns = {column.number},
            .format = std::string{unit.word},
            .since_1970 = true,
            .has_date = true,
            .confidence = Confidence::sure,
            .reason = fmt::format("{} since 1970", unit.word),
            .t_s = scaled(column.values, unit.unit_s)};
}

/// Tests whether a name speaks of GPS time, which counts from 1980 or from the beginning of a week.
bool is_gps_count(const std::string& name) {
    const auto lower = ascii_lower(name);
    const auto has = [&](std::string_view word) { return lower.find(word) != std::string::npos; };
    return (has("gps") || has("gnss") || has("tow")) && !has("unix") && !has("utc");
}

/// Tests whether a name speaks of a unit of time that is none of number_units.
bool names_other_unit(const std::string& name) {
    const auto lower = ascii_lower(name);
    const auto has = [&](std::string_view word) { return lower.find(word) != std::string::npos; };
    return has("minute") || has("[min]") || has("(min)") || has("hour") || has("tick");
}

std::optional<DetectedTime> as_number(const LogColumn& column) {
    const double middle = known_median(column.values);
    const auto steps = steps_of(column.values);
    if (!is_like_time(steps)) {
        return std::nullopt;
    }
    const auto* const named = std::ranges::find(number_units, column.named.unit, &NumberUnit::word);
    const bool is_named = named != number_units.end();
    const double named_step_s = is_named ? steps.median_s * named->unit_s : unknown;
    const bool fits_name = named_step_s >= shortest_step_s && named_step_s <= longest_epoch_step_s;
    for (const auto& unit : number_units) {
        const double middle_s = middle * unit.unit_s;
        const double step_s = steps.median_s * unit.unit_s;
        const bool contradicts_name = fits_name && unit.word != named->word;
        if (middle_s >= earliest_s && middle_s <= latest_s && step_s <= longest_epoch_step_s &&
            !contradicts_name && !is_gps_count(column.name)) {
            return as_epoch(column, unit);
        }
    }
    if (auto clock = as_compact_clock(column)) {
        return clock;
    }
    const bool is_whole = are_whole(column.values);
    const auto name = ascii_lower(column.name);
    const bool is_milli = name.find("milli") != std::string::npos || name == "itow"; // of u-blox
    const auto by_steps = unit_by_steps(steps.median_s, is_whole);
    const auto unit = is_named ? *named : is_milli ? number_units[1] : by_steps;
    const double step_s = steps.median_s * unit.unit_s;
    const bool is_tick = name.find("tick") != std::string::npos;
    const bool is_guess = !is_named && !is_milli && (!names_other_unit(column.name) || is_tick) &&
                          step_s >= shortest_step_s && // a longitude rises, too
                          (is_whole || steps.median_s > 1.5);
    const bool is_sure =
        is_named   ? step_s >= shortest_step_s && step_s <= longest_step_s
        : is_milli ? by_steps.word == unit.word
                   : !is_guess && step_s >= shortest_step_s && !names_other_unit(column.name);
    return DetectedTime{
        .columns = {column.number},
        .format = std::string{unit.word},
        .is_guess = is_guess,
        .confidence = is_sure ? Confidence::sure : Confidence::likely,
        .step_s = step_s,
        .reason =
            fmt::format("steps of {:.4g} s{}", step_s, is_guess ? ", a guess by their size" : ""),
        .t_s = scaled(column.values, unit.unit_s)};
}

std::vector<std::string> joined(const LogColumn& date, const LogColumn& clock) {
    auto texts = date.texts;
    for (std::size_t i = 0; i < texts.size(); ++i) {
        texts[i] += " " + clock.texts[i];
    }
    return texts;
}

/// Reads texts in a format; `std::nullopt` if more than one in fifty does not fit.
std::optional<DetectedTime>
as_text(std::vector<std::string> texts, const TextFormat& format, char decimal) {
    TimeMapping mapping;
    mapping.format = format.format;
    DetectedTime time{.columns = {}, .format = std::string{format.word}};
    std::size_t faults = 0;
    std::size_t dated = 0;
    double midnights_s = 0;
    double last_s = 0;
    for (auto& text : texts) {
        if (decimal == ',') {
            std::ranges::replace(text, ',', '.');
        }
        const auto read = parse_time(text, mapping);
        faults += read || trimmed(text).empty() ? 0U : 1U;
        dated += read && read->dated ? 1U : 0U;
        if (read && format.format == TimeFormat::clock && read->s < last_s - 43200) {
            midnights_s += 86400;
        }
        last_s = read ? read->s : last_s;
        time.t_s.push_back(read ? read->s + midnights_s : unknown);
    }
    time.has_date = dated * 2 > texts.size();
    const bool fits = faults * 50 <= texts.size() && is_like_time(steps_of(time.t_s));
    return fits ? std::optional{std::move(time)} : std::nullopt;
}

/// Reads texts in the first format that fits; a date that could be read in two ways is not sure if
/// it counts.
std::optional<DetectedTime> as_any_text(const std::vector<std::string>& texts, char decimal) {
    std::optional<DetectedTime> first;
    for (const auto& format : text_formats) {
        auto time = as_text(texts, format, decimal);
        if (time && first) {
            first->confidence = first->has_date ? Confidence::likely : Confidence::sure;
            first->reason += "; day and month may be swapped";
            return first;
        }
        if (time) {
            first = std::move(time);
            first->confidence = Confidence::sure;
            first->reason = first->has_date ? "date and time with a time zone"
                                            : "a time of day without a time zone";
            if (steps_of(first->t_s).median_s > longest_step_s) { // minutes and seconds
                first->confidence = Confidence::likely;
                first->reason += "; rows are far apart";
            }
        }
    }
    return first;
}

/// Pairs of columns of text that may be a date and a time of day: the first that are named so, or
/// neighbours without names.
std::vector<std::pair<const LogColumn*, const LogColumn*>>
date_and_clock_columns(const LogTable& table) {
    std::vector<std::pair<const LogColumn*, const LogColumn*>> pairs;
    const auto first = [&](Quantity quantity) {
        return std::ranges::find_if(table.columns, [&](const LogColumn& column) {
            return column.named.quantity == quantity && !column.texts.empty();
        });
    };
    const auto date = first(Quantity::date);
    const auto clock = first(Quantity::time);
    if (date != table.columns.end() && clock != table.columns.end()) {
        pairs.emplace_back(&*date, &*clock);
    }
    for (std::size_t i = 1; table.dialect.names.empty() && i < table.columns.size(); ++i) {
        const auto& left = table.columns[i - 1];
        const auto& right = table.columns[i];
        if (!left.texts.empty() && !right.texts.empty()) {
            pairs.emplace_back(&left, &right);
        }
    }
    return pairs;
}

std::vector<DetectedTime> candidates_in(const LogTable& table) {
    std::vector<DetectedTime> found;
    const auto add = [&](std::optional<DetectedTime> time, std::vector<std::size_t> columns) {
        if (time) {
            time->columns = std::move(columns);
            found.push_back(std::move(*time));
        }
    };
    const char decimal = table.dialect.decimal;
    for (const auto& column : table.columns) {
        const auto quantity = column.named.quantity;
        const bool may_be =
            quantity == Quantity::time || quantity == Quantity::date || table.dialect.names.empty();
        if (column.is_numeric() && may_be && quantity != Quantity::date) {
            add(as_number(column), {column.number});
        } else if (!column.texts.empty()) { // what parses as a time is one, whatever its name
            add(as_any_text(column.texts, decimal), {column.number});
        }
    }
    for (const auto& [date, clock] : date_and_clock_columns(table)) {
        add(as_any_text(joined(*date, *clock), decimal), {date->number, clock->number});
    }
    return found;
}

/// Order of preference: as fine as the rows, sure, dated, a count rather than a text, and leftmost.
auto rank(const DetectedTime& time) {
    const auto steps = steps_of(time.t_s);
    const bool is_count = time.format.size() <= 2;
    return std::tuple{steps.rising >= fine_rising_share,
                      time.confidence == Confidence::sure,
                      time.has_date,
                      is_count,
                      time.columns.size(),
                      -static_cast<std::ptrdiff_t>(time.columns.front())};
}

} // namespace

std::vector<DetectedTime> other_units_of(const DetectedTime& time) {
    std::vector<DetectedTime> others;
    const auto guess = *std::ranges::find(number_units, time.format, &NumberUnit::word);
    for (const auto& unit : number_units) {
        for (const double scale : {1.0, 0.1, 0.01}) {
            if (unit.word == "ns" || (unit.word == time.format && scale == 1)) {
                continue;
            }
            auto other = time;
            other.format = unit.word;
            other.scale = scale;
            other.t_s = scaled(time.t_s, scale * unit.unit_s / guess.unit_s);
            other.step_s = steps_of(other.t_s).median_s;
            others.push_back(std::move(other));
        }
    }
    return others;
}

std::string unit_words(const DetectedTime& time) {
    return time.scale == 1 ? time.format : fmt::format("{:g} {}", time.scale, time.format);
}

std::optional<DetectedTime> detect_time(const LogTable& table) {
    auto found = candidates_in(table);
    if (found.empty()) {
        return std::nullopt;
    }
    auto best = std::ranges::max_element(
        found, [](const auto& a, const auto& b) { return rank(a) < rank(b); });
    if (!std::get<0>(rank(*best)) && (best->confidence == Confidence::sure || best->is_guess)) {
        best->confidence = Confidence::likely;
        best->is_guess = false;
        best->reason += "; coarser than the rows";
    }
    return std::move(*best);
}

} // namespace macadam
