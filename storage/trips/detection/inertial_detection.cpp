#include "storage/trips/detection/inertial_detection.hpp"

#include "estimator/common/gravity.hpp"
#include "storage/trips/mappings/unit_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace macadam {
namespace {

constexpr std::size_t min_samples = 20;
constexpr double gravity_tolerance = 0.12; // sensors, slopes and braking together
constexpr double no_gravity_share = 0.35;  // of it, that may remain in the mean without it

/// The columns of one sensor, by axis; null: none.
struct Sensor {
    Quantity quantity = Quantity::unknown;
    bool of_vehicle = false;
    bool is_apple = false;
    std::string unit{};
    std::array<const LogColumn*, 3> axes{};

    std::size_t count() const {
        return static_cast<std::size_t>(
            std::ranges::count_if(axes, [](const auto* axis) { return axis != nullptr; }));
    }
};

/// Sensors of the given quantities: columns whose names differ in the axis alone.
std::vector<Sensor> sensors_of(const LogTable& table, std::initializer_list<Quantity> quantities) {
    std::map<std::pair<std::string, bool>, Sensor> by_family;
    std::vector<std::pair<std::string, bool>> order;
    for (const auto& column : table.columns) {
        const auto& named = column.named;
        const bool is_asked = std::ranges::find(quantities, named.quantity) != quantities.end();
        if (!is_asked || named.axis.number == 0 || column.values.empty() ||
            column.count < min_samples) {
            continue;
        }
        const std::pair key{named.axis.of_vehicle ? "" : named.family, named.axis.of_vehicle};
        auto& sensor = by_family[key];
        if (sensor.quantity == Quantity::unknown) {
            order.push_back(key);
            sensor.quantity = named.quantity;
        }
        sensor.of_vehicle = named.axis.of_vehicle;
        sensor.is_apple = sensor.is_apple || named.is_apple;
        sensor.unit = sensor.unit.empty() ? named.unit : sensor.unit;
        auto& axis = sensor.axes[static_cast<std::size_t>(named.axis.number - 1)];
        axis = axis == nullptr ? &column : axis;
    }
    std::vector<Sensor> sensors;
    for (const auto& key : order) {
        sensors.push_back(by_family[key]);
    }
    return sensors;
}

double mean_of(const LogColumn* column) {
    double sum = 0;
    std::size_t count = 0;
    for (const double value : column == nullptr ? std::vector<double>{} : column->values) {
        if (!std::isnan(value)) {
            sum += value;
            ++count;
        }
    }
    return count == 0 ? 0 : sum / static_cast<double>(count);
}

/// Length of the mean vector.
double mean_length(const Sensor& sensor) {
    double square = 0;
    for (const auto* axis : sensor.axes) {
        square += mean_of(axis) * mean_of(axis);
    }
    return std::sqrt(square);
}

struct AccelerationUnit {
    std::string_view word;
    double gravity; ///< in that unit
    double scale = 1;
};
constexpr std::array<AccelerationUnit, 8> units{
    AccelerationUnit{"m/s2", standard_gravity_mps2},
    AccelerationUnit{"g", 1},
    AccelerationUnit{"mg", 1000},
    AccelerationUnit{"ft/s2", standard_gravity_mps2 / 0.3048},
    // counts of a sensor of ±2, 4, 8 and 16 g with 16 bits
    AccelerationUnit{"g", 16384, 1.0 / 16384},
    AccelerationUnit{"g", 8192, 1.0 / 8192},
    AccelerationUnit{"g", 4096, 1.0 / 4096},
    AccelerationUnit{"g", 2048, 1.0 / 2048}};

bool is_near(double value, double gravity) {
    return std::abs(value / gravity - 1) < gravity_tolerance;
}

/// Reading of an accelerometer.
struct Acceleration {
    Sensor sensor{};
    AccelerationUnit unit{"", 1};
    bool has_gravity = false;
    Confidence confidence = Confidence::likely;
    std::string reason{};
};

/// Tests whether gravity shows which way is up: by all three axes, or because z points along it.
/// (Of the axes of a vehicle, the vertical one may be read alone.)
bool has_vertical(const Sensor& sensor, double mean) {
    return (sensor.count() == 3 && !sensor.of_vehicle) ||
           (sensor.axes[2] != nullptr && is_near(std::abs(mean_of(sensor.axes[2])), mean));
}

Acceleration named_acceleration(const Sensor& sensor, double mean) {
    const auto unit = *std::ranges::find(units, sensor.unit, &AccelerationUnit::word);
    Acceleration read{.sensor = sensor, .unit = unit, .reason = {}};
    const bool sees_gravity = has_vertical(sensor, mean);
    if (is_near(mean, unit.gravity) && sees_gravity) {
        read.has_gravity = true;
        read.confidence = Confidence::sure;
        read.reason = "unit in its name, and by gravity";
        return read;
    }
    const auto other = std::ranges::find_if(
        units, [&](const AccelerationUnit& u) { return is_near(mean, u.gravity); });
    if (mean < no_gravity_share * unit.gravity && (other == units.end() || unit.word != "m/s2")) {
        // Whose z axis points up is known of the axes of a vehicle alone.
        read.confidence = sensor.of_vehicle ? Confidence::sure : Confidence::likely;
        read.reason = sensor.of_vehicle ? "unit in its name; gravity was removed"
                                        : "gravity was removed: which axis points up is not known";
        return read;
    }
    read.has_gravity = sees_gravity && mean > no_gravity_share * unit.gravity;
    read.reason =
        fmt::format("its mean is {:.3g} {}, expected {:g} or 0", mean, unit.word, unit.gravity);
    return read;
}

Acceleration acceleration_of(const Sensor& sensor) {
    const double mean = mean_length(sensor);
    if (!sensor.unit.empty()) {
        return named_acceleration(sensor, mean);
    }
    Acceleration read{.sensor = sensor, .reason = {}};
    const auto unit = std::ranges::find_if(
        units, [&](const AccelerationUnit& u) { return is_near(mean, u.gravity); });
    if (unit != units.end()) {
        read.unit = *unit;
        read.has_gravity = true;
        read.confidence = has_vertical(sensor, mean) ? Confidence::sure : Confidence::likely;
        read.reason = fmt::format("by gravity, {:.4g}", mean);
    } else {
        read.reason =
            fmt::format("no unit in its name, and its mean of {:.3g} is no gravity", mean);
    }
    return read;
}

/// Order of preference: sure, with gravity, more axes.
auto rank(const Acceleration& acceleration) {
    return std::tuple{acceleration.confidence == Confidence::sure,
                      acceleration.has_gravity,
                      acceleration.sensor.axes[2] != nullptr,
                      acceleration.sensor.count()};
}

/// Finds an accelerometer in columns that are named x, y and z alone: likely if their mean is
/// gravity.
std::optional<Acceleration> bare_acceleration(const LogTable& table) {
    Sensor sensor{.quantity = Quantity::acceleration};
    for (const auto& column : table.columns) {
        const auto name = ascii_lower(column.name);
        if (name.size() == 1 && name.front() >= 'x' && name.front() <= 'z' && column.is_numeric() &&
            column.count >= min_samples) {
            sensor.axes[static_cast<std::size_t>(name.front() - 'x')] = &column;
        }
    }
    auto read = acceleration_of(sensor);
    read.confidence = Confidence::likely;
    read.reason += ", but their names say x, y, z alone";
    return sensor.count() == 3 && read.has_gravity ? std::optional{read} : std::nullopt;
}

/// Finds an accelerometer in a table without names: the first three neighbouring columns whose
/// mean is gravity. It is likely at best.
std::optional<Acceleration> unnamed_acceleration(const LogTable& table) {
    const auto may_be_axis = [](const LogColumn& column) {
        return column.is_numeric() && column.count >= min_samples &&
               !std::ranges::is_sorted(column.values); // not a time
    };
    for (std::size_t i = 0; table.dialect.names.empty() && i + 3 <= table.columns.size(); ++i) {
        const std::span<const LogColumn> three{table.columns.data() + i, 3};
        if (!std::ranges::all_of(three, may_be_axis)) {
            continue;
        }
        auto read = acceleration_of(
            {.quantity = Quantity::acceleration, .axes = {&three[0], &three[1], &three[2]}});
        if (read.has_gravity) {
            read.confidence = Confidence::likely;
            return read;
        }
    }
    return std::nullopt;
}

constexpr std::array<std::string_view, 3> acc_channels{"acc_x_mps2", "acc_y_mps2", "acc_z_mps2"};
constexpr std::array<std::string_view, 3> gyro_channels{
    "gyro_x_radps", "gyro_y_radps", "gyro_z_radps"};

void add(const Acceleration& read, DetectedInertia& to) {
    const bool is_upside_down =
        read.sensor.of_vehicle && read.has_gravity && mean_of(read.sensor.axes[2]) < 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (read.sensor.axes[axis] == nullptr) {
            continue;
        }
        // Which way along and across count as positive differs from maker to maker.
        const bool is_sign_known = !read.sensor.of_vehicle || axis == 2;
        to.channels.push_back(
            {.channel = std::string{acc_channels[axis]},
             .column = read.sensor.axes[axis]->number,
             .unit = std::string{read.unit.word},
             .scale = read.unit.scale,
             .sign = read.sensor.is_apple || (is_upside_down && axis == 2) ? -1 : 1,
             .confidence = is_sign_known ? read.confidence : Confidence::likely,
             .reason = is_sign_known ? read.reason : "check its sign"});
    }
    if (read.unit.word.empty()) {
        return;
    }
    const double mean_mps2 = mean_length(read.sensor) * standard_gravity_mps2 / read.unit.gravity;
    to.has_gravity = read.has_gravity;
    to.gravity = read.has_gravity ? fmt::format("{:.2f} m/s2, included", mean_mps2)
                                  : fmt::format("removed (mean {:.2f} m/s2)", mean_mps2);
}

/// 95th percentile of the rates about any axis.
double large_rate(const Sensor& sensor) {
    std::vector<double> rates;
    for (const auto* axis : sensor.axes) {
        for (const double value : axis == nullptr ? std::vector<double>{} : axis->values) {
            if (!std::isnan(value)) {
                rates.push_back(std::abs(value));
            }
        }
    }
    if (rates.empty()) {
        return 0;
    }
    const auto at = rates.begin() + static_cast<std::ptrdiff_t>(rates.size() * 95 / 100);
    std::nth_element(rates.begin(), at, rates.end());
    return *at;
}

void add_rates(const Sensor& sensor, bool is_moving, DetectedInertia& to) {
    // In a car, one rate in twenty exceeds 0.02 to 0.3 rad/s, which is 1 to 17 deg/s.
    constexpr double max_radps = 1.5;
    constexpr double sure_radps = 0.35;
    constexpr double max_degps = 120;
    const double rate = large_rate(sensor);
    const bool may_be_rad = rate < max_radps;
    const bool may_be_deg = rate > sure_radps && rate < max_degps;
    const bool is_rad = rate < sure_radps && rate > 0 && is_moving;
    const bool is_deg = rate >= max_radps && may_be_deg;
    const auto unit = !sensor.unit.empty() ? sensor.unit
                      : is_rad             ? "rad/s"
                      : is_deg             ? "deg/s"
                                           : ""; // cannot be told
    const bool agrees =
        sensor.unit.empty() ? !unit.empty() : (unit == "rad/s" ? may_be_rad : may_be_deg);
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (sensor.axes[axis] != nullptr) {
            to.channels.push_back(
                {.channel = std::string{gyro_channels[axis]},
                 .column = sensor.axes[axis]->number,
                 .unit = unit,
                 .confidence = agrees && !sensor.of_vehicle ? Confidence::sure : Confidence::likely,
                 .reason = sensor.of_vehicle ? "check its sign"
                           : agrees          ? "its values are those of a car"
                           : unit.empty() && rate < sure_radps
                               ? "rad/s of a drive, or deg/s of a car that stands"
                               : fmt::format("one value in twenty exceeds {:.3g}", rate)});
        }
    }
}

} // namespace

DetectedInertia detect_inertia(const LogTable& table, bool is_moving) {
    auto sensors = sensors_of(table, {Quantity::acceleration, Quantity::linear_acceleration});
    auto rates = sensors_of(table, {Quantity::angular_rate, Quantity::angular_rate_or_g});
    const auto g_or_rate = std::ranges::find(rates, Quantity::angular_rate_or_g, &Sensor::quantity);
    if (sensors.empty() && g_or_rate != rates.end() &&
        acceleration_of(*g_or_rate).confidence == Confidence::sure) { // gx, gy, gz in g
        sensors.push_back(*g_or_rate);
        rates.erase(g_or_rate);
    }
    DetectedInertia found;
    if (!sensors.empty()) {
        std::vector<Acceleration> readings;
        std::ranges::transform(sensors, std::back_inserter(readings), acceleration_of);
        const auto best = std::ranges::max_element(
            readings, [](const auto& a, const auto& b) { return rank(a) < rank(b); });
        found.of_device = !best->sensor.of_vehicle;
        add(*best, found);
    }
    if (const auto bare = bare_acceleration(table); bare && sensors.empty()) {
        found.of_device = true;
        add(*bare, found);
    }
    if (const auto unnamed = unnamed_acceleration(table)) {
        found.of_device = true;
        add(*unnamed, found);
    }
    const auto rate = std::ranges::find_if(rates, [&](const Sensor& sensor) {
        return sensors.empty() || sensor.of_vehicle != found.of_device;
    });
    if (rate != rates.end()) {
        add_rates(*rate, is_moving, found);
    }
    return found;
}

} // namespace macadam
