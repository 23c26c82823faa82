#include "storage/store/fusion/fusion_settings.hpp"

#include "storage/store/rows/segment_row.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace macadam {
namespace {

constexpr double millionths = 1e6;
constexpr double um_per_mm = 1000;

struct Setting {
    const char* key;
    double FusionConfig::*value;
    double unit; ///< integer steps per unit
};

constexpr std::array settings{
    Setting{"common_share_ppm", &FusionConfig::common_share, millionths},
    Setting{"car_share_ppm", &FusionConfig::car_share, millionths},
    Setting{"max_common_sd_ppm", &FusionConfig::max_common_relative_sd, millionths},
    Setting{"max_common_sd_um", &FusionConfig::max_common_sd_mm_per_m, um_per_mm},
    Setting{"trip_sd_ppm", &FusionConfig::trip_relative_sd, millionths},
    Setting{"rest_sd_ppm", &FusionConfig::rest_relative_sd, millionths},
    Setting{"rest_sd_um", &FusionConfig::rest_sd_mm_per_m, um_per_mm},
    Setting{"anchor_sd_ppm", &FusionConfig::anchor_relative_sd, millionths},
};

std::int64_t whole(double value, double unit) {
    return std::llround(value * unit);
}

CarPeriod period_in(const Statement& row) {
    constexpr double max_scatter = 100; // of a database that was modified by another program
    CarPeriod period{.from_ms = known_utc_ms(row, 2), .change = {}, .calibration = {}};
    const auto share = [&](int column) {
        return static_cast<double>(row.integer(column)) / millionths;
    };
    if (!row.is_null(3)) {
        period.calibration = CarCalibration{.gain = share(3),
                                            .offset_um = static_cast<double>(row.integer(4)),
                                            .relative_sd = share(5),
                                            .scatter = std::clamp(share(6), 1.0, max_scatter)};
    }
    period.shared = static_cast<std::size_t>(row.integer(7));
    if (!row.is_null(8)) {
        period.change = CarChange{.level = share(8), .level_sd = share(9), .scatter = share(10)};
    }
    return period;
}

void read_periods(Database& database, CarRecords& cars) {
    auto select = database.prepare(
        "SELECT vehicle, number, from_ms, gain_ppm, offset_um, sd_ppm, scatter_ppm, passes,"
        " change_ppm, change_sd_ppm, change_scatter_ppm FROM calibration_period"
        " WHERE number = 0 OR from_ms IS NOT NULL ORDER BY vehicle, number");
    while (select.step()) {
        if (const auto car = cars.find(select.integer(0)); car != cars.end()) {
            car->second.periods.push_back(period_in(select));
        }
    }
}

void write_periods(Database& database, const CarRecords& cars) {
    auto insert =
        database.prepare("INSERT INTO calibration_period VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    const auto ppm = [](double value) { return whole(value, millionths); };
    for (const auto& [vehicle, car] : cars) {
        for (std::size_t i = 0; i < car.periods.size(); ++i) {
            const auto& [from_ms, change, calibration, shared] = car.periods[i];
            const auto of_calibration = [&](double CarCalibration::*value, double unit) {
                return calibration ? std::optional{whole((*calibration).*value, unit)}
                                   : std::nullopt;
            };
            const auto of_change = [&](double CarChange::*value) {
                return change ? std::optional{ppm((*change).*value)} : std::nullopt;
            };
            insert.run(vehicle,
                       static_cast<std::int64_t>(i),
                       from_ms,
                       of_calibration(&CarCalibration::gain, millionths),
                       of_calibration(&CarCalibration::offset_um, 1),
                       of_calibration(&CarCalibration::relative_sd, millionths),
                       ppm(calibration ? calibration->scatter : 1),
                       static_cast<std::int64_t>(shared),
                       of_change(&CarChange::level),
                       of_change(&CarChange::level_sd),
                       of_change(&CarChange::scatter));
        }
    }
}

} // namespace

FusionConfig read_fusion_config(Database& database) {
    FusionConfig config;
    auto select = database.prepare("SELECT value FROM fusion_setting WHERE key = ?");
    for (const auto& [key, value, unit] : settings) {
        if (select.bind(key).step()) {
            config.*value = static_cast<double>(select.integer(0)) / unit;
        }
    }
    return config;
}

void write_fusion_config(Database& database, const FusionConfig& config) {
    auto insert = database.prepare("INSERT OR REPLACE INTO fusion_setting VALUES (?, ?)");
    for (const auto& [key, value, unit] : settings) {
        insert.run(key, whole(config.*value, unit));
    }
}

CarRecords read_calibrations(Database& database) {
    CarRecords cars;
    auto select = database.prepare(
        "SELECT vehicle, gain_ppm, offset_um, sd_ppm, trips, passes FROM calibration");
    while (select.step()) {
        const CarCalibration calibration{
            .gain = static_cast<double>(select.integer(1)) / millionths,
            .offset_um = static_cast<double>(select.integer(2)),
            .relative_sd = static_cast<double>(select.integer(3)) / millionths};
        cars[select.integer(0)] = {calibration, select.integer(4), select.integer(5)};
    }
    read_periods(database, cars);
    return cars;
}

void write_calibrations(Database& database, const CarRecords& cars) {
    database.run("DELETE FROM calibration");
    auto insert = database.prepare("INSERT INTO calibration VALUES (?, ?, ?, ?, ?, ?)");
    for (const auto& [vehicle, car] : cars) {
        insert.run(vehicle,
                   whole(car.calibration.gain, millionths),
                   whole(car.calibration.offset_um, 1),
                   whole(car.calibration.relative_sd, millionths),
                   car.trips,
                   car.passes);
    }
    database.run("DELETE FROM calibration_period");
    write_periods(database, cars);
}

void erase_calibrations_without_trips(Database& database) {
    constexpr const char* without_trips =
        " WHERE vehicle NOT IN (SELECT vehicle FROM trip WHERE vehicle IS NOT NULL)";
    database.run(std::string{"DELETE FROM calibration"} + without_trips);
    database.run(std::string{"DELETE FROM calibration_period"} + without_trips);
}

ValidFrom::ValidFrom(Database& database)
    : select_{database.prepare(
          "SELECT segment, from_ms FROM valid_from WHERE segment >= ? AND segment < ?")} {}

std::unordered_map<std::int64_t, std::int64_t> ValidFrom::of(std::int64_t first,
                                                             std::int64_t past) {
    std::unordered_map<std::int64_t, std::int64_t> from_ms;
    for (select_.bind(first, past); select_.step();) {
        from_ms[select_.integer(0)] = select_.integer(1);
    }
    select_.reset();
    return from_ms;
}

} // namespace macadam
