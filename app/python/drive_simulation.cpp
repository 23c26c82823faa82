#include "app/python/drive_simulation.hpp"

#include "estimator/common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

namespace macadam {
namespace {

constexpr double motion_step_s = 0.01;
constexpr double min_speed_mps = 1;
constexpr double max_speed_mps = 60;

const MeasuredProfile::Track& track_of(const MeasuredProfile& profile, std::string_view name) {
    const auto found = std::ranges::find(profile.tracks, name, &MeasuredProfile::Track::name);
    if (found != profile.tracks.end()) {
        return *found;
    }
    if (profile.tracks.size() > 1) {
        throw InputError{fmt::format("the profile has {} tracks and none of them is '{}', expected "
                                     "left and right, or one track",
                                     profile.tracks.size(),
                                     name)};
    }
    return profile.tracks.front();
}

/// Returns the elevations above the first of them, so that the road begins without a step.
std::vector<float> from_zero(const std::vector<double>& elevation_m) {
    std::vector<float> road;
    road.reserve(elevation_m.size());
    for (const double height_m : elevation_m) {
        if (!std::isfinite(height_m)) {
            throw InputError{fmt::format(
                "value {} of the profile is {}, expected metres", road.size() + 1, height_m)};
        }
        road.push_back(static_cast<float>(height_m - elevation_m.front()));
    }
    return road;
}

RoadUnderWheels road_of(const MeasuredProfile& profile) {
    if (!profile.even_step_m) {
        throw InputError{"the profile has uneven stations, expected even ones"};
    }
    if (profile.station_m.size() < 2) {
        throw InputError{fmt::format("the profile has {} points, expected at least two",
                                     profile.station_m.size())};
    }
    return {.step_m = *profile.even_step_m,
            .left_m = from_zero(track_of(profile, "left").elevation_m),
            .right_m = from_zero(track_of(profile, "right").elevation_m)};
}

Motion steady_motion(double length_m, double speed_mps) {
    const auto steps = static_cast<std::size_t>(length_m / speed_mps / motion_step_s) + 1;
    Motion motion{.step_s = motion_step_s,
                  .travel_m = {},
                  .speed_mps = std::vector(steps, speed_mps),
                  .acc_mps2 = std::vector(steps, 0.0),
                  .yaw_rate_radps = std::vector(steps, 0.0)};
    for (std::size_t i = 0; i < steps; ++i) {
        motion.travel_m.push_back(static_cast<double>(i) * motion_step_s * speed_mps);
    }
    return motion;
}

} // namespace

ImuReadings
simulate_drive(const MeasuredProfile& profile, const Vehicle& vehicle, const DriveConfig& config) {
    if (!(config.speed_mps >= min_speed_mps && config.speed_mps <= max_speed_mps)) {
        throw InputError{fmt::format("the speed is {} m/s, expected {:g} to {:g}",
                                     config.speed_mps,
                                     min_speed_mps,
                                     max_speed_mps)};
    }
    const auto road = road_of(profile);
    const double length_m = road.step_m * static_cast<double>(road.left_m.size() - 1);
    const auto motion = steady_motion(length_m, config.speed_mps);
    if (motion.travel_m.size() < 2) {
        throw InputError{
            fmt::format("the profile is {:g} m long, too short for this speed", length_m)};
    }
    CarRecipe car{.vehicle = vehicle};
    car.friction_n = vehicle.half_car.friction_n.value_or(config.friction_n);
    return simulate_imu(car, config.imu, road, motion, config.seed);
}

} // namespace macadam
