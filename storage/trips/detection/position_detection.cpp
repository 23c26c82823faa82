#include "storage/trips/detection/position_detection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

namespace macadam {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double metres_per_degree = 111'195; // of a great circle
constexpr double deg_in_rad = std::numbers::pi / 180;

constexpr double min_moving_mps = 3;    // slower fixes have no course
constexpr double longest_step_s = 15;   // between fixes
constexpr std::size_t min_samples = 15; // of a comparison
constexpr double near_ratio = 0.06;     // a knot is 15 % more than a mile per hour
constexpr double close_ratio = 0.2;     // of a unit that is named
constexpr double max_course_error_deg = 20;
constexpr double largest_extent_deg = 10; // of a trip

/// Way between two fixes that differ.
struct Way {
    std::size_t row; ///< of the later one
    double speed_mps;
    double course_deg;
};

const LogColumn* first_of(const LogTable& table, Quantity quantity) {
    const auto found = std::ranges::find_if(table.columns, [&](const LogColumn& column) {
        return column.named.quantity == quantity && column.is_numeric();
    });
    return found == table.columns.end() ? nullptr : &*found;
}

/// Extreme values other than 0, which stands for no position.
std::pair<double, double> range_of(const std::vector<double>& values) {
    std::pair<double, double> range{std::numeric_limits<double>::infinity(),
                                    -std::numeric_limits<double>::infinity()};
    for (const double value : values) {
        if (value != 0 && !std::isnan(value)) {
            range = {std::min(range.first, value), std::max(range.second, value)};
        }
    }
    return range;
}

bool varies(const LogColumn& column) {
    const auto [low, high] = range_of(column.values);
    return high > low;
}

/// Column beside a coordinate that holds only the two letters of a hemisphere; null if there is
/// none, or if the coordinate has a sign already.
const LogColumn*
hemisphere_column(const LogTable& table, const LogColumn& coordinate, std::string_view letters) {
    if (range_of(coordinate.values).first < 0) {
        return nullptr;
    }
    const auto is_letter = [&](const std::string& text) {
        return text.empty() ||
               (text.size() == 1 && letters.find(text.front()) != std::string_view::npos);
    };
    const auto found = std::ranges::find_if(table.columns, [&](const LogColumn& column) {
        const bool is_beside =
            column.number == coordinate.number + 1 || column.number + 1 == coordinate.number;
        return is_beside && !column.texts.empty() && std::ranges::all_of(column.texts, is_letter);
    });
    return found == table.columns.end() ? nullptr : &*found;
}

/// One coordinate: how its numbers become degrees.
struct Coordinate {
    DetectedChannel channel{};
    std::vector<double> deg{}; ///< by row
};

double degrees_of(double value, const DetectedChannel& channel) {
    if (channel.unit != "ddmm.mmmm") {
        return value * channel.scale * channel.sign;
    }
    const double whole = std::trunc(value / 100);
    return whole + (value - 100 * whole) / 60;
}

/// \param hemisphere  its column; null: none
void set_degrees(Coordinate& coordinate, const LogColumn& column, const LogColumn* hemisphere) {
    constexpr std::string_view negative{"SWsw"};
    for (std::size_t i = 0; i < column.values.size(); ++i) {
        const double value = column.values[i];
        const bool is_negated = hemisphere != nullptr && !hemisphere->texts[i].empty() &&
                                negative.find(hemisphere->texts[i].front()) != negative.npos;
        const double deg = value == 0 ? unknown : degrees_of(value, coordinate.channel);
        coordinate.deg.push_back(is_negated ? -deg : deg);
    }
}

double largest_of(const LogColumn& column) {
    const auto [low, high] = range_of(column.values);
    return std::max(std::abs(low), std::abs(high));
}

/// Tests whether two columns can be degrees. Both are written alike: near Greenwich, minutes of a
/// longitude would pass for degrees.
bool may_be_degrees(const LogColumn& lat, const LogColumn& lon) {
    const auto fits = [](double largest, double limit) {
        return largest <= limit || std::isinf(largest);
    };
    return fits(largest_of(lat), 90) && fits(largest_of(lon), 180);
}

bool are_minutes(const std::vector<double>& values) {
    return std::ranges::all_of(
        values, [](double v) { return std::isnan(v) || std::fmod(std::abs(v), 100) < 60; });
}

/// Reads degrees, ddmm.mmmm, minutes of VBOX files, and whole degrees times 1e7, 1e6 or 1e5.
Coordinate coordinate_of(const LogTable& table,
                         const LogColumn& column,
                         bool is_latitude,
                         bool may_be_degrees,
                         double whole_scale) {
    const double limit = is_latitude ? 90 : 180;
    const auto [low, high] = range_of(column.values);
    const double largest = std::max(std::abs(low), std::abs(high));
    Coordinate read{.channel = {.channel = is_latitude ? "lat_deg" : "lon_deg",
                                .column = column.number,
                                .unit = ""},
                    .deg = {}};
    auto& channel = read.channel;
    const auto* const hemisphere = hemisphere_column(table, column, is_latitude ? "NSns" : "EWew");
    if (hemisphere != nullptr) {
        channel.hemisphere = hemisphere->number;
    }
    const bool is_whole = std::ranges::all_of(
        column.values, [](double v) { return std::isnan(v) || v == std::floor(v); });
    const bool is_vbox = table.dialect.names.front() == "sats";
    if (may_be_degrees && largest <= limit && (!is_whole || !varies(column))) {
        channel.confidence = is_vbox ? Confidence::likely : Confidence::sure;
        channel.reason = fmt::format("{:.2f} to {:.2f} degrees", low, high);
    } else if (is_vbox && largest <= limit * 60) {
        channel.scale = 1.0 / 60;
        channel.sign = is_latitude ? 1 : -1; // west is positive
        channel.confidence = Confidence::sure;
        channel.reason = "minutes, as VBOX writes them";
    } else if (largest < limit * 100 && are_minutes(column.values) && !is_whole) {
        channel.unit = "ddmm.mmmm";
        channel.confidence = channel.hemisphere ? Confidence::sure : Confidence::likely;
        channel.reason = "degrees and minutes as in NMEA";
    } else if (is_whole && largest >= 1e5) {
        channel.scale = whole_scale;
        channel.confidence = largest * whole_scale <= limit && whole_scale == 1e-7
                                 ? Confidence::sure
                                 : Confidence::likely;
        channel.reason = fmt::format("whole numbers of {:g} degrees", channel.scale);
    } else {
        channel.reason = fmt::format("{:g} to {:g} are no degrees", low, high);
    }
    set_degrees(read, column, hemisphere);
    if (high - low > largest_extent_deg / channel.scale) {
        channel.confidence = Confidence::likely;
        channel.reason += "; further apart than a trip is";
    }
    return read;
}

/// Scale of whole numbers, the same of both: the largest that is a position. That of 1e-7 is sure,
/// as others would lie beyond the poles or the antimeridian.
double whole_scale_of(const LogColumn& lat, const LogColumn& lon) {
    for (const double scale : {1e-5, 1e-6}) {
        if (largest_of(lat) * scale <= 90 && largest_of(lon) * scale <= 180) {
            return scale;
        }
    }
    return 1e-7;
}

/// Ways from each fix to the next one that differs.
std::vector<Way> ways_of(const Coordinate& lat, const Coordinate& lon, const DetectedTime& time) {
    std::vector<Way> ways;
    std::optional<std::size_t> last;
    for (std::size_t i = 0; i < time.t_s.size(); ++i) {
        if (std::isnan(lat.deg[i]) || std::isnan(lon.deg[i]) || std::isnan(time.t_s[i])) {
            continue;
        }
        if (last && lat.deg[i] == lat.deg[*last] && lon.deg[i] == lon.deg[*last]) {
            continue;
        }
        if (last) {
            const double north_m = (lat.deg[i] - lat.deg[*last]) * metres_per_degree;
            const double east_m = (lon.deg[i] - lon.deg[*last]) * metres_per_degree *
                                  std::cos(lat.deg[i] * deg_in_rad);
            const double step_s = time.t_s[i] - time.t_s[*last];
            if (step_s > 0.02 && step_s < longest_step_s) {
                ways.push_back({i,
                                std::hypot(north_m, east_m) / step_s,
                                std::atan2(east_m, north_m) / deg_in_rad});
            }
        }
        last = i;
    }
    return ways;
}

struct SpeedUnit {
    std::string_view word;
    double mps;
};
constexpr std::array<SpeedUnit, 4> speed_units{SpeedUnit{"m/s", 1},
                                               SpeedUnit{"km/h", 1 / 3.6},
                                               SpeedUnit{"mph", 0.44704},
                                               SpeedUnit{"kn", 1852.0 / 3600}};

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

/// Decides the unit of a speed by its name, and by the way where that is known.
DetectedChannel
speed_of(const LogColumn& column, std::string channel, const std::vector<Way>& ways) {
    DetectedChannel speed{.channel = std::move(channel),
                          .column = column.number,
                          .unit = column.named.unit,
                          .minus_one_is_none = has_minus_one(column)};
    const double ratio = speed_ratio(column, ways);
    const auto error = [&](const SpeedUnit& unit) { return std::abs(ratio * unit.mps - 1); };
    const auto nearest = std::ranges::min(speed_units, std::less{}, error);
    if (speed.unit.empty()) {
        speed.unit = std::isnan(ratio) ? "" : std::string{nearest.word};
        speed.confidence = error(nearest) < near_ratio ? Confidence::sure : Confidence::likely;
        speed.reason = std::isnan(ratio) ? "no unit in its name, and no positions to compare with"
                       : error(nearest) < close_ratio
                           ? "by the way between positions"
                           : "contradicts the way between positions in every unit";
    } else if (std::isnan(ratio)) {
        speed.confidence = Confidence::sure;
        speed.reason = "unit in its name";
    } else {
        const auto named = *std::ranges::find(speed_units, speed.unit, &SpeedUnit::word);
        const bool agrees = error(named) < close_ratio;
        speed.confidence = agrees ? Confidence::sure : Confidence::likely;
        speed.reason = agrees
                           ? "unit in its name, and by the way between positions"
                           : fmt::format("contradicts the way between positions, which is {:.2f} "
                                         "times as long",
                                         1 / (ratio * named.mps));
    }
    return speed;
}

DetectedChannel course_of(const LogColumn& column, const std::vector<Way>& ways) {
    std::vector<double> errors_deg;
    for (const auto& way : ways) {
        const double value = column.values[way.row];
        if (way.speed_mps > min_moving_mps && !std::isnan(value)) {
            errors_deg.push_back(std::abs(std::remainder(value - way.course_deg, 360)));
        }
    }
    const double error_deg = errors_deg.size() < min_samples ? unknown : known_median(errors_deg);
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
    const auto [low, high] = range_of(column.values);
    const bool plausible = (low > 0 || has_minus_one(column)) && known_median(column.values) < 500;
    return {.channel = "hacc_m",
            .column = column.number,
            .unit = column.named.unit,
            .minus_one_is_none = has_minus_one(column),
            .confidence = plausible ? Confidence::sure : Confidence::likely,
            .reason = fmt::format("up to {:.0f}", high)};
}

/// Finds the speeds: the receiver's and the car's; one that does not say whose it is belongs to the
/// receiver if there are positions.
void add_speeds(const LogTable& table,
                bool has_positions,
                const std::vector<Way>& ways,
                std::vector<DetectedChannel>& found) {
    const auto* const plain = first_of(table, Quantity::speed);
    const auto* gnss = first_of(table, Quantity::gnss_speed);
    const auto* car = first_of(table, Quantity::vehicle_speed);
    if (plain != nullptr && has_positions && gnss == nullptr) {
        gnss = plain;
    } else if (plain != nullptr && car == nullptr) {
        car = plain;
    }
    if (gnss != nullptr) {
        found.push_back(speed_of(*gnss, "gnss_speed_mps", ways));
    }
    if (car != nullptr) {
        found.push_back(speed_of(*car, "speed_mps", ways));
        if (found.back().unit == "kn") { // no car counts in knots
            found.back().unit = "";
            found.back().confidence = Confidence::likely;
        }
    }
}

/// Tests whether a speed contradicts the way: then time or positions are wrong.
bool is_contradicted(const std::vector<DetectedChannel>& speeds) {
    return std::ranges::any_of(speeds, [](const DetectedChannel& speed) {
        return speed.reason.starts_with("contradicts");
    });
}

} // namespace

std::vector<DetectedChannel> detect_positions(const LogTable& table, const DetectedTime* time) {
    std::vector<DetectedChannel> found;
    const auto* const lat = first_of(table, Quantity::latitude);
    const auto* const lon = first_of(table, Quantity::longitude);
    std::vector<Way> ways;
    const bool has_positions = lat != nullptr && lon != nullptr;
    if (has_positions) {
        const double scale = whole_scale_of(*lat, *lon);
        const bool in_degrees = may_be_degrees(*lat, *lon);
        auto latitude = coordinate_of(table, *lat, true, in_degrees, scale);
        auto longitude = coordinate_of(table, *lon, false, in_degrees, scale);
        if (time != nullptr) {
            ways = ways_of(latitude, longitude, *time);
        }
        found.push_back(std::move(latitude.channel));
        found.push_back(std::move(longitude.channel));
    }
    if (has_positions && !varies(*lat) && !varies(*lon)) {
        for (auto& channel : found) {
            channel.confidence = Confidence::likely;
            channel.reason += "; always the same";
        }
    }
    add_speeds(table, has_positions, ways, found);
    if (has_positions && is_contradicted(found)) {
        for (std::size_t i = 0; i < 2; ++i) {
            found[i].confidence = Confidence::likely;
            found[i].reason += "; contradicts the speed";
        }
    }
    if (const auto* const course = first_of(table, Quantity::course)) {
        found.push_back(course_of(*course, ways));
    }
    if (const auto* const accuracy = first_of(table, Quantity::accuracy)) {
        found.push_back(accuracy_of(*accuracy));
    }
    return found;
}

} // namespace macadam
