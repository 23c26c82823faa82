#include "storage/store/fusion/fusion_settings.hpp"

#include <array>
#include <cmath>

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
    Setting{"trip_sd_ppm", &FusionConfig::trip_relative_sd, millionths},
    Setting{"rest_sd_ppm", &FusionConfig::rest_relative_sd, millionths},
    Setting{"rest_sd_um", &FusionConfig::rest_sd_mm_per_m, um_per_mm},
    Setting{"anchor_sd_ppm", &FusionConfig::anchor_relative_sd, millionths},
};

std::int64_t whole(double value, double unit) {
    return std::llround(value * unit);
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
