#pragma once

#include "driven_road.hpp"

#include <span>

namespace macadam::testing {

/// A road and a car that drives it; docs/method/accuracy.md lists them.
struct World {
    const char* name;
    RoadRecipe road;
    Axles axles;
    double imu_ahead_m;
};

/// Roads of MRI 1 to 6 of several wavinesses, and with joints, patches and potholes; cars of 2.4 to
/// 3.3 m wheelbase.
std::span<const World> worlds();

/// Metres to drive in each: 1,200, or ten kilometres with MACADAM_TEST_ALL set.
double drive_length_m();

/// The drive of the world's car, which is what its vehicle says.
DriveRecipe drive_in(const World& world, double speed_kmh);

inline constexpr SensorSet every_sensor{
    .vertical = true, .lateral = true, .roll = true, .pitch = true, .yaw = true};

/// What maps are made of.
inline constexpr SensorSet vertical_and_pitch{.vertical = true, .pitch = true};

/// What users get of these sensors: a car tuned by the stretch, then the smoother.
IriRun smoothed(const Stretch& stretch, const Vehicle& vehicle, const SensorSet& sensors);

/// The published filter on the vertical or the lateral channel.
IriRun filtered(const Stretch& stretch, const Vehicle& vehicle, Channels channels);

/// Adds pieces of one drive, relative to its mean MRI, to those of others.
void append(std::vector<Held>& set, const std::vector<Held>& pieces);

/// One line of the suite's report.
void print(const char* what, double speed_kmh, const std::vector<Held>& pieces);

} // namespace macadam::testing
