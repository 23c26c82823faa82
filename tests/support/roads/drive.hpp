#pragma once

#include "estimator/common/trip.hpp"
#include "estimator/vehicle/vehicle.hpp"

#include <functional>
#include <string>

namespace macadam::testing {

/// A straight road from `start`, `course_deg` clockwise from north (0, 90, 180 or 270), as seen
/// from a car with one axle under its centre of gravity that drives it at constant speed.
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

/// The place `distance_m` along the drive.
GeoPoint place_of(const Drive& drive, double distance_m);

/// What the car's sensors say, without noise: a quarter car by Runge-Kutta in millisecond steps.
TripLog drive_over(const Road& road, const Drive& drive, const Vehicle& vehicle);

/// The trip as the text of a "macadam-trip 1" log.
std::string text_of(const TripLog& trip, const Drive& drive);

/// A road of a few sines, smooth but where `is_rough`, there `factor` times as high.
Road patched_road(std::function<bool(double distance_m)> is_rough, double factor);

} // namespace macadam::testing
