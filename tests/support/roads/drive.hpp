#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <functional>
#include <string>

namespace macadam::testing {

/// Straight road from `start`, `course_deg` clockwise from north (0, 90, 180 or 270), driven at
/// constant speed by a car with one axle under its centre of gravity.
struct Drive {
    GeoPoint start{48.0, 11.0};
    double course_deg = 90;
    double length_m = 1000;
    double speed_mps = 20;
    double rate_hz = 100;
    double gnss_hz = 10;
    double gnss_latency_s = 0.2;
    bool wheel_speed = true;
    std::string trip_id = "drive";
    std::string vehicle_id = "golden-car";
    std::string t0_utc = "2026-03-01T08:00:00Z";
};

/// Elevation of the road, m, at a distance from the start of the drive.
using Road = std::function<double(double distance_m)>;

/// Returns the position `distance_m` along the drive.
GeoPoint place_of(const Drive& drive, double distance_m);

/// Simulates the car's sensors without noise: a quarter car by Runge-Kutta in millisecond steps.
TripLog drive_over(const Road& road, const Drive& drive, const Vehicle& vehicle);

/// Formats the trip as a "macadam-trip 1" log.
std::string text_of(const TripLog& trip, const Drive& drive);

/// Builds a road of a few sines, with `factor` times the height where `is_rough`.
Road patched_road(std::function<bool(double distance_m)> is_rough, double factor);

} // namespace macadam::testing
