#include "storage/trips/detection/position_detection.hpp"

#include "storage/trips/detection/coordinate_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
#include <utility>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double metres_per_degree = 111'195; // of a great circle
constexpr double deg_in_rad = std::numbers::pi / 180;

constexpr double min_moving_mps = 3;    // slower fixes have no course
constexpr double shortest_step_s = 0.5; // between fixes; shorter ways are rounded off
constexpr double longest_step_s = 15;
constexpr std::size_t min_samples = 15; // of a comparison
constexpr double near_ratio = 0.06;     // a knot is 15 % more than a mile per hour
constexpr double close_ratio = 0.2;     // of a unit that is named
constexpr double exact_ratio = 0.02;    // of a receiver's speed and the way
constexpr double max_course_error_deg = 20;

/// Way between two fixes that differ.
struct Way {
    std::size_t row; ///< of the later one
    double duration_s;
    double speed_mps;
    double course_deg;
};

const LogColumn* first_of(const LogTable& table, Quantity quantity) {
    const auto found = std::ranges::find_if(table.columns, [&](const LogColumn& column) {
        return column.named.quantity == quantity && column.is_numeric();
    });
    return found == table.columns.end() ? nullptr : &*found;
}

/// Ways from each fix to the next one that differs and is at least half a second later.
std::vector<Way> ways_of(const Coordinates& at, const DetectedTime& time) {
    const auto& lat_deg = at.latitude.deg;
    const auto& lon_deg = at.longitude.deg;
    std::vector<Way> ways;
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < time.t_s.size(); ++i) {
        if (std::isnan(lat_deg[i]) || std::isnan(lon_deg[i]) || std::isnan(time.t_s[i])) {
            continue;
        }
        const double step_s = last ? time.t_s[i] - time.t_s[*last] : -1;
        const bool is_new = last && (lat_deg[i] != lat_deg[*last] || lon_deg[i] != lon_deg[*last]);
        if (last && step_s >= 0 && (!is_new || step_s < shortest_step_s)) {
            continue;
        }
        if (is_new && step_s >= shortest_step_s && step_s < longest_step_s) {
            const double north_m = (lat_deg[i] - lat_deg[*last]) * metres_per_degree;
            const double east_m = (lon_deg[i] - lon_deg[*last]) * metres_per_degree *
                                  std::cos(lat_deg[i] * deg_in_rad);
            ways.push_back({i,
                            step_s,
                            std::hypot(north_m, east_m) / step_s,
                            std::atan2(east_m, north_m) / deg_in_rad});
        }
        last = i;
    }
    return ways;
}

struct SpeedUnit {
    std::string_view word;
    double mps;
};
constexpr std::array<SpeedUnit, 6> speed_units{SpeedUnit{"m/s", 1},
                                               SpeedUnit{"km/h", 1 / 3.6},
                                               SpeedUnit{"mph", 0.44704},
                                               SpeedUnit{"kn", 1852.0 / 3600},
                                               SpeedUnit{"cm/s", 0.01},
                                               SpeedUnit{"mm/s", 0.001}};
// Of a time whose unit is a guess, such as 10 us for ms, the last two would be another guess.
constexpr std::size_t all_units = speed_units.size();
constexpr std::size_t units_of_guessed_time = 4;

/// Median of a column's speeds over those of the way; NaN if too few are known.
double speed_ratio(const LogColumn& column, const std::vector<Way>& ways) {
    std::vector<double> ratios;
    for (const auto& way : ways) {
        const double value = column.values[way.row];
        if (way.speed_mps > min_moving_mps && !std::isnan(value)) {
            ratios.push_back(value / way.speed_mps);
        }
    }
    return ratios.size() < min_samples ? unknown : known_median(std::move(ratios));
}

bool has_minus_one(const LogColumn& column) {
    const auto low = std::ranges::min(column.values, std::less{}, [](double v) {
        return std::isnan(v) ? std::numeric_limits<double>::infinity() : v;
    });
    return low == -1 && std::ranges::find(column.values, -1) != column.values.end();
}

/// Relative error of a unit, if the speeds are `ratio` times those of the way.
double unit_error(double ratio, const SpeedUnit& unit) {
    return std::abs(ratio * unit.mps - 1);
}

/// Unit that a name states, else the one of the first `count` that fits the way best.
SpeedUnit
unit_of(const LogColumn& column, double ratio, std::size_t count = units_of_guessed_time) {
    const auto* const named = std::ranges::find(speed_units, column.named.unit, &SpeedUnit::word);
    return named != speed_units.end()
               ? *named
               : std::ranges::min(std::span{speed_units}.first(count),
                                  std::less{},
                                  [&](const SpeedUnit& unit) { return unit_error(ratio, unit); });
}

/// Decides the unit of a speed by its name, and among the first `units` by the way where that is
/// known.
DetectedChannel speed_of(const LogColumn& column,
                         std::string channel,
                         const std::vector<Way>& ways,
                         std::size_t units,
                         DetectedPositions& found) {
    DetectedChannel speed{.channel = std::move(channel),
                          .column = column.number,
                          .unit = column.named.unit,
                          .minus_one_is_none = has_minus_one(column)};
    const bool is_named = !speed.unit.empty();
    const double ratio = speed_ratio(column, ways);
    if (std::isnan(ratio)) {
        speed.confidence = is_named ? Confidence::sure : Confidence::likely;
        speed.reason =
            is_named ? "unit in its name" : "no unit in its name, and no positions to compare with";
        return speed;
    }
    const auto unit = unit_of(column, ratio, units);
    const double error = unit_error(ratio, unit);
    speed.unit = unit.word;
    const bool agrees = error < (is_named ? close_ratio : near_ratio);
    speed.confidence = agrees ? Confidence::sure : Confidence::likely;
    speed.reason = is_named && agrees ? "unit in its name, and by the way between positions"
                   : is_named
                       ? fmt::format("contradicts the way between positions, which is {:.2f} "
                                     "times as long",
                                     1 / (ratio * unit.mps))
                   : error < close_ratio ? "by the way between positions"
                                         : "contradicts the way between positions in every unit";
    found.speed_agrees = found.speed_agrees || agrees;
    found.speed_contradicts = found.speed_contradicts || error >= close_ratio;
    return speed;
}

/// Median angle between a column of courses and the way; NaN if too few are known.
double course_error_deg(const LogColumn& column, const std::vector<Way>& ways) {
    std::vector<double> errors_deg;
    for (const auto& way : ways) {
        const double value = column.values[way.row];
        if (way.speed_mps > min_moving_mps && !std::isnan(value)) {
            errors_deg.push_back(std::abs(std::remainder(value - way.course_deg, 360)));
        }
    }
    return errors_deg.size() < min_samples ? unknown : known_median(std::move(errors_deg));
}

DetectedChannel course_of(const LogColumn& column, const std::vector<Way>& ways) {
    const double error_deg = course_error_deg(column, ways);
    const bool agrees = error_deg < max_course_error_deg;
    return {.channel = "course_deg",
            .column = column.number,
            .unit = "",
            .minus_one_is_none = has_minus_one(column),
            .confidence = agrees ? Confidence::sure : Confidence::likely,
            .reason = agrees ? "follows the way between positions"
                      : std::isnan(error_deg)
                          ? "too few positions to compare with"
                          : fmt::format("{:.0f} degrees off the way between positions", error_deg)};
}

DetectedChannel accuracy_of(const LogColumn& column) {
    const auto [low, high] = nonzero_range(column.values);
    const bool plausible = (low > 0 || has_minus_one(column)) && known_median(column.values) < 500;
    return {.channel = "hacc_m",
            .column = column.number,
            .unit = column.named.unit,
            .minus_one_is_none = has_minus_one(column),
            .confidence = plausible ? Confidence::sure : Confidence::likely,
            .reason = fmt::format("up to {:.0f}", high)};
}

/// Speeds of a log: the receiver's and the car's; null: none.
struct Speeds {
    const LogColumn* gnss = nullptr;
    const LogColumn* car = nullptr;
};

/// Finds the speeds; one that does not say whose it is belongs to the receiver if there are
/// positions.
Speeds speeds_in(const LogTable& table, bool has_positions) {
    const auto* const plain = first_of(table, Quantity::speed);
    Speeds speeds{first_of(table, Quantity::gnss_speed), first_of(table, Quantity::vehicle_speed)};
    if (plain != nullptr && has_positions && speeds.gnss == nullptr) {
        speeds.gnss = plain;
    } else if (plain != nullptr && speeds.car == nullptr) {
        speeds.car = plain;
    }
    return speeds;
}

void add_speeds(const Speeds& speeds,
                const std::vector<Way>& ways,
                const DetectedTime* time,
                DetectedPositions& found) {
    const auto units = time == nullptr || time->is_guess ? units_of_guessed_time : all_units;
    if (speeds.gnss != nullptr) {
        found.channels.push_back(speed_of(*speeds.gnss, "gnss_speed_mps", ways, units, found));
    }
    if (speeds.car != nullptr) {
        auto speed = speed_of(*speeds.car, "speed_mps", ways, units, found);
        const bool is_receivers =
            speed.unit == "kn" || speed.unit == "cm/s" || speed.unit == "mm/s";
        if (is_receivers) { // no car counts in these
            speed.unit = "";
            speed.confidence = Confidence::likely;
        }
        found.channels.push_back(std::move(speed));
    }
}

/// Which of two readings of the positions another column fits.
enum class Verdict { open, as_named, exchanged };

Verdict verdict_of(double error_as_named, double error_exchanged, double max_error, double margin) {
    if (error_as_named < max_error && error_as_named + margin < error_exchanged) {
        return Verdict::as_named;
    }
    return error_exchanged < max_error && error_exchanged + margin < error_as_named
               ? Verdict::exchanged
               : Verdict::open;
}

/// Tests whether course and speed fit only if the columns of latitude and longitude carry each
/// other's names. Along a meridian or parallel the speed alone may leave that open.
bool are_exchanged(const std::vector<Way>& as_named,
                   const std::vector<Way>& exchanged,
                   const LogColumn* course,
                   const LogColumn* speed) {
    const auto by_course = course == nullptr ? Verdict::open
                                             : verdict_of(course_error_deg(*course, as_named),
                                                          course_error_deg(*course, exchanged),
                                                          max_course_error_deg,
                                                          max_course_error_deg / 2);
    const auto speed_error = [&](const std::vector<Way>& ways) {
        const double ratio = speed_ratio(*speed, ways);
        return unit_error(ratio, unit_of(*speed, ratio));
    };
    const auto by_speed =
        speed == nullptr
            ? Verdict::open
            : verdict_of(speed_error(as_named), speed_error(exchanged), exact_ratio, exact_ratio);
    const bool speaks_for = by_course == Verdict::exchanged || by_speed == Verdict::exchanged;
    const bool speaks_against = by_course == Verdict::as_named || by_speed == Verdict::as_named;
    return speaks_for && !speaks_against;
}

/// Reads the positions by the names of their columns, or with the names exchanged if course or
/// speed show it.
Coordinates positions_of(const LogTable& table,
                         const LogColumn& lat,
                         const LogColumn& lon,
                         const DetectedTime& time,
                         const LogColumn* speed) {
    auto as_named = read_coordinates(table, lat, lon);
    auto exchanged = read_coordinates(table, lon, lat);
    if (!are_exchanged(ways_of(as_named, time),
                       ways_of(exchanged, time),
                       first_of(table, Quantity::course),
                       speed)) {
        return as_named;
    }
    for (auto* const channel : {&exchanged.latitude.channel, &exchanged.longitude.channel}) {
        channel->confidence = Confidence::likely;
        channel->reason += "; course or speed fit only if the names of latitude and longitude are "
                           "exchanged";
    }
    return exchanged;
}

/// Tests whether a speed, or else the ways show that the car moved for at least half of the time.
bool is_moving(const Speeds& speeds, const std::vector<Way>& ways, const DetectedTime* time) {
    for (const auto* const column : {speeds.gnss, speeds.car}) {
        if (column != nullptr) {
            const auto unit = unit_of(*column, speed_ratio(*column, ways));
            return known_median(column->values) * unit.mps > min_moving_mps;
        }
    }
    double moving_s = 0;
    for (const auto& way : ways) {
        moving_s += way.speed_mps > min_moving_mps ? way.duration_s : 0;
    }
    const auto [first_s, last_s] = time == nullptr ? std::pair{0.0, 0.0} : nonzero_range(time->t_s);
    return time != nullptr && !time->is_guess && moving_s * 2 > last_s - first_s;
}

} // namespace

DetectedPositions detect_positions(const LogTable& table, const DetectedTime* time) {
    DetectedPositions found;
    const auto* const lat = first_of(table, Quantity::latitude);
    const auto* const lon = first_of(table, Quantity::longitude);
    const bool has_positions = lat != nullptr && lon != nullptr;
    const auto speeds = speeds_in(table, has_positions);
    std::vector<Way> ways;
    if (has_positions) {
        const auto at = time == nullptr ? read_coordinates(table, *lat, *lon)
                                        : positions_of(table, *lat, *lon, *time, speeds.gnss);
        ways = time == nullptr ? ways : ways_of(at, *time);
        found.channels = {at.latitude.channel, at.longitude.channel};
    }
    add_speeds(speeds, ways, time, found);
    if (has_positions && found.speed_contradicts) {
        for (std::size_t i = 0; i < 2; ++i) {
            found.channels[i].confidence = Confidence::likely;
            found.channels[i].reason += "; contradicts the speed";
        }
    }
    found.is_moving = is_moving(speeds, ways, time);
    if (const auto* const course = first_of(table, Quantity::course)) {
        found.channels.push_back(course_of(*course, ways));
    }
    if (const auto* const accuracy = first_of(table, Quantity::accuracy)) {
        found.channels.push_back(accuracy_of(*accuracy));
    }
    return found;
}

} // namespace macadam
