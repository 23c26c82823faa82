#pragma once

#include "estimator/common/trip.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace macadam::testing {

/// Sensors of a car; each set includes the one before it.
enum class Sensors : std::uint8_t {
    positions, ///< 1 Hz
    odometer,  ///< wheel speed, 10 Hz, 0.5 % too fast
    gyro,      ///< yaw rate, 10 Hz, with a bias
};
inline constexpr Sensors all_sensor_sets[] = {Sensors::positions, Sensors::odometer, Sensors::gyro};

std::string name_of(Sensors sensors);

struct Stop {
    double at_m; ///< along the line
    double for_s;
};

struct Silence {
    double from_m; ///< along the line; no positions up to to_m
    double to_m;
};

struct CarConfig {
    double cruise_mps = 14; ///< slower before corners above 50 degrees and stops, at 2 m/s2
    double noise_m = 3;     ///< position error per axis; correlated over 30 s, one fifth white
    double lane_m = 2;      ///< offset to the right of the line
    std::vector<Stop> stops{};
    std::vector<Silence> silences{};
    std::uint64_t seed = 1;
};

/// Drives a line and returns the trip.
TripLog sensed(const std::vector<GeoPoint>& line, Sensors sensors, const CarConfig& config = {});

} // namespace macadam::testing
