#pragma once

#include "estimator/common/trip.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace macadam::testing {

/// What a car tells of its way; each set has what the one before it has.
enum class Sensors : std::uint8_t {
    positions, ///< one a second
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
    double from_m; ///< along the line: no positions between these
    double to_m;
};

struct CarConfig {
    double cruise_mps = 14; ///< less before corners of more than 50 degrees and stops, at 2 m/s2
    double noise_m = 3;     ///< of a position, per axis; fades over 30 s, a fifth of it at once
    double lane_m = 2;      ///< to the right of the line
    std::vector<Stop> stops{};
    std::vector<Silence> silences{};
    std::uint64_t seed = 1;
};

/// The trip of a car along a line of places.
TripLog sensed(const std::vector<GeoPoint>& line, Sensors sensors, const CarConfig& config = {});

} // namespace macadam::testing
