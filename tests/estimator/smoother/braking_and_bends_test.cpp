// What leans on a car is not the road: beside the same car on the same road that nothing leans on.

#include "bounds.hpp"
#include "worlds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <ostream>

namespace macadam::testing {
namespace {

constexpr double segment_m = 40;
constexpr double fastest_mps = 80 / 3.6;
constexpr double braking_mps2 = 3;
constexpr double speeding_up_mps2 = 1.5;
constexpr double bend_mps2 = 3;

/// From 0 to 1 and back within a time, by half waves of a cosine at both ends.
double push(double t_s, double long_s, double ramp_s) {
    if (t_s < 0 || t_s > long_s) {
        return 0;
    }
    const double from_end_s = std::min(t_s, long_s - t_s);
    return from_end_s > ramp_s ? 1 : (1 - std::cos(std::numbers::pi * from_end_s / ramp_s)) / 2;
}

/// Brakes from 80 to 40 km/h within 4 s, again and again.
double acceleration_mps2(double t_s) {
    const double at_s = std::fmod(t_s, 16);
    return speeding_up_mps2 * push(at_s - 6, 7.6, 0.4) - braking_mps2 * push(at_s, 4, 0.4);
}

/// Bends to the left and to the right, 5 s each.
double bend(double t_s) {
    const double at_s = std::fmod(t_s, 14);
    return push(at_s, 5, 1.5) - push(at_s - 7, 5, 1.5);
}

struct Drive {
    bool brakes, bends;
};

Motion motion_of(const Drive& drive, double length_m) {
    Motion motion{
        .step_s = 0.02, .travel_m = {}, .speed_mps = {}, .acc_mps2 = {}, .yaw_rate_radps = {}};
    double speed_mps = fastest_mps;
    double travel_m = 5;
    for (double t_s = 0; travel_m < length_m - 5; t_s += motion.step_s) {
        const double acc_mps2 = drive.brakes ? acceleration_mps2(t_s) : 0;
        motion.travel_m.push_back(travel_m);
        motion.speed_mps.push_back(speed_mps);
        motion.acc_mps2.push_back(acc_mps2);
        motion.yaw_rate_radps.push_back(drive.bends ? bend_mps2 * bend(t_s) / speed_mps : 0);
        travel_m += motion.step_s * (speed_mps + motion.step_s * acc_mps2 / 2);
        speed_mps += motion.step_s * acc_mps2;
    }
    return motion;
}

/// The index along the drive by a car with arms for braking and bends to turn it.
std::vector<Held>
read(const World& world, const Motion& motion, bool leans, const SensorSet& sensors, Index index) {
    auto recipe = drive_in(world, 80);
    recipe.car.pitch_arm_m = leans ? 0.35 : 0;
    recipe.car.cg_above_roll_axis_m = leans ? 0.45 : 0;
    const auto& car = recipe.car.vehicle;
    const auto [stretch, truth] = driven_road(recipe, motion);
    return held_beside(smoothed(stretch, car, sensors), truth, index, segment_m, car);
}

struct Lean {
    const char* name;
    Drive drive;
    SensorSet sensors;
    Index index;
    Bound apart; ///< bias from that of the car that nothing leans on
};

void PrintTo(const Lean& lean, std::ostream* out) {
    *out << lean.name;
}

class WhatLeansOnACar : public ::testing::TestWithParam<Lean> {};

TEST_P(WhatLeansOnACar, IsNotReadAsRoad) {
    const auto& [name, drive, sensors, index, apart] = GetParam();
    std::vector<Held> leaning;
    std::vector<Held> upright;
    for (const auto& world : worlds()) {
        const auto leant = motion_of(drive, drive_length_m());
        const auto straight = motion_of({drive.brakes, false}, drive_length_m());
        append(leaning, read(world, leant, true, sensors, index));
        append(upright, read(world, straight, false, sensors, index));
    }
    print(name, 80, leaning);
    print("the same car, nothing leaning on it", 80, upright);
    expect_at_most(name, std::abs(errors_of(leaning).bias - errors_of(upright).bias), apart);
}

INSTANTIATE_TEST_SUITE_P(Drives,
                         WhatLeansOnACar,
                         ::testing::Values(Lean{"braking, vertical + pitch rate: HRI",
                                                {.brakes = true, .bends = false},
                                                vertical_and_pitch,
                                                Index::hri,
                                                {.wanted = 0.03}},
                                           Lean{"bends, all: MRI",
                                                {.brakes = false, .bends = true},
                                                every_sensor,
                                                Index::mri,
                                                {.wanted = 0.03}}));

} // namespace
} // namespace macadam::testing
