#include "storage/trips/mappings/column_units.hpp"

#include "estimator/common/gravity.hpp"
#include "storage/tables/toml.hpp"
#include "storage/trips/mappings/unit_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>

namespace macadam {

namespace {

constexpr double deg_in_rad = 0.017453292519943295; // pi / 180

struct Unit {
    std::string_view name;
    TripColumn first; ///< of the channels to which the unit applies
    TripColumn last;
    double factor;
};

// clang-format off
constexpr Unit units[] = {
    {"m/s2", TripColumn::acc_x, TripColumn::acc_z, 1},
    {"m/s^2", TripColumn::acc_x, TripColumn::acc_z, 1},
    {"g", TripColumn::acc_x, TripColumn::acc_z, standard_gravity_mps2},
    {"mg", TripColumn::acc_x, TripColumn::acc_z, standard_gravity_mps2 / 1000},
    {"ft/s2", TripColumn::acc_x, TripColumn::acc_z, 0.3048},
    {"rad/s", TripColumn::gyro_x, TripColumn::gyro_z, 1},
    {"deg/s", TripColumn::gyro_x, TripColumn::gyro_z, deg_in_rad},
    {"m/s", TripColumn::speed, TripColumn::wheel_rr, 1},
    {"km/h", TripColumn::speed, TripColumn::wheel_rr, 1 / 3.6},
    {"mph", TripColumn::speed, TripColumn::wheel_rr, 0.44704},
    {"m/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 1},
    {"cm/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.01},
    {"mm/s", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.001},
    {"km/h", TripColumn::gnss_speed, TripColumn::gnss_speed, 1 / 3.6},
    {"mph", TripColumn::gnss_speed, TripColumn::gnss_speed, 0.44704},
    {"kn", TripColumn::gnss_speed, TripColumn::gnss_speed, 1852.0 / 3600},
    {"deg", TripColumn::lat, TripColumn::lon, 1},
    {degrees_minutes, TripColumn::lat, TripColumn::lon, 1},
    {"deg", TripColumn::course, TripColumn::course, 1},
    {"m", TripColumn::hacc, TripColumn::hacc, 1},
    {"ft", TripColumn::hacc, TripColumn::hacc, 0.3048},
};
// clang-format on

double unit_of(const TomlTable& table, TripColumn channel) {
    if (!table.has("unit")) {
        return 1;
    }
    const auto name = table.text("unit");
    std::string expected;
    for (const auto& unit : units) {
        if (channel < unit.first || channel > unit.last) {
            continue;
        }
        if (unit.name == name) {
            return unit.factor;
        }
        expected += fmt::format("{}{}", expected.empty() ? "one of " : ", ", unit.name);
    }
    table.refuse("unit", expected.empty() ? "no unit for this channel" : expected);
}

} // namespace

double scale_of(const TomlTable& table, TripColumn channel) {
    const double sign = table.has("sign") && table.integer("sign", -1, 1) < 0 ? -1 : 1;
    return sign * unit_of(table, channel) * table.maybe_number("scale").value_or(1);
}

std::optional<double> unit_factor(TripColumn channel, std::string_view unit) {
    const auto is_of_channel = [&](const Unit& known) {
        return channel >= known.first && channel <= known.last;
    };
    if (std::ranges::none_of(units, is_of_channel)) {
        return 1; // a code or a count
    }
    for (const auto kind : {UnitKind::acceleration,
                            UnitKind::angular_rate,
                            UnitKind::speed,
                            UnitKind::angle,
                            UnitKind::length}) {
        const auto word = unit_named(kind, unit);
        const auto* const found = std::ranges::find_if(
            units, [&](const Unit& known) { return word == known.name && is_of_channel(known); });
        if (word && found != std::end(units)) {
            return found->factor;
        }
    }
    return std::nullopt;
}

} // namespace macadam
