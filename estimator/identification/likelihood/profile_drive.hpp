#pragma once

#include "estimator/identification/likelihood/car_parameters.hpp"
#include "estimator/identification/road_profile.hpp"
#include "estimator/motion/stretch.hpp"
#include "estimator/smoother/car/drive_record.hpp"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace macadam {

/// Elevations at even stations: mean of the tracks, and half their difference, left minus right.
struct EvenRoad {
    double first_m;
    double step_m;
    std::vector<Pair> elevation_m;
};

/// Readings of a part of a drive, and the measured road under it.
struct ProfileDrive {
    double step_s;
    std::vector<double> station_m; ///< of the centre of gravity, by the odometer
    std::array<std::vector<double>, channel_count> felt; ///< over the file's gain; empty: not used
    EvenRoad road;     ///< under both axles and some metres beyond; level beyond its ends
    double left_out_m; ///< travel on the profile beyond the longest that is used
};

/// Longest travel that is used, about the middle of the drive. The memory of a fit grows with its
/// square: each of the 100 corrections of the stations has the derivatives of all readings. On a
/// quarter of it, springs and dampers are already known to what the model's simplifications leave.
inline constexpr double max_drive_m = 5000;

/// Selects the part of a stretch whose wheels were on the profile, and the channels that determine
/// a car: vertical acceleration, pitch rate and, if both tracks were measured, roll rate, or the
/// lateral acceleration in its place where the sensor's height is known. Of a longer drive, the
/// max_drive_m nearest its middle are selected.
///
/// \param at_m  station of the profile at the trip's travel 0.
/// \returns     `std::nullopt` if they share fewer than two samples, or without vertical
///              acceleration.
std::optional<ProfileDrive> drive_on_profile(const Stretch& stretch,
                                             const RoadProfile& profile,
                                             const Vehicle& vehicle,
                                             double at_m);

using Readings = std::array<std::vector<double>, channel_count>;

/// Simulates the readings of a car with dry friction and one-sided dampers over the road. It starts
/// at rest, so the first seconds contain its start-up transient. The linear part is exact for a
/// road of straight lines of 2.5 ms; the forces of friction are extrapolated over half a step
/// (Adams-Bashforth).
///
/// \param drive      its road and its channels that are used
/// \param file_gain  gain by which drive.felt was divided
/// \param shift_m    added to the stations, same size as drive.station_m
Readings simulated_readings(const ProfileDrive& drive,
                            const FittedCar& car,
                            double file_gain,
                            std::span<const double> shift_m);

} // namespace macadam
