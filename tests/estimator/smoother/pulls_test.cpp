// What braking and bends do to the body is not read as road.

#include "driven_road.hpp"
#include "estimator/roughness/roughness_mean.hpp"
#include "estimator/smoother/car/discrete_car.hpp"
#include "estimator/smoother/smoothed_iri.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

namespace macadam::testing {
namespace {

constexpr double pitch_arm_m = 0.45; // of a passenger car: neither is what the smoother begins with
constexpr double roll_arm_m = 0.6;

Vehicle car() {
    return two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.2}, 0.3);
}

/// A drive of 240 m at an even speed, straight on.
const DrivenRoad& even_drive() {
    static const DrivenRoad driven = driven_road({.road = {.iri_mm_per_m = 2},
                                                  .car = linear_car_of(car()),
                                                  .length_m = 240,
                                                  .speed_kmh = 60,
                                                  .speed_swing = 0});
    return driven;
}

/// A pull that comes and goes within 1.5 s.
double pull_mps2(double t_s) {
    return 3 * std::pow(std::sin(std::numbers::pi * t_s / 1.5), 3);
}

/// What leans the body under the pull at every sample, added to what was felt.
Stretch leant(Stretch stretch, LateralInput kind, double arm_m) {
    const auto steps = car_steps(linear_car(car()), stretch.step_s);
    const auto column = static_cast<int>(kind);
    CarState x = CarState::Zero();
    for (std::size_t k = 1; k < stretch.travel_m.size(); ++k) {
        const double t_s = (static_cast<double>(k) - 0.5) * stretch.step_s;
        x = steps.phi * x + steps.lean.col(column) * arm_m * pull_mps2(t_s);
        const auto felt = [&](Channel channel) {
            return static_cast<float>(steps.car.felt[static_cast<std::size_t>(channel)] * x);
        };
        stretch.vertical_mps2[k] += felt(Channel::vertical);
        stretch.roll_radps[k] += felt(Channel::roll_rate);
        stretch.pitch_radps[k] += felt(Channel::pitch_rate);
    }
    return stretch;
}

/// The same drive on which the brakes bite and let go; the speed tells of it, if it is to.
Stretch braked(bool told) {
    auto stretch = leant(even_drive().stretch, LateralInput::braking, pitch_arm_m);
    double lost_mps = 0;
    for (std::size_t k = 1; k < stretch.speed_mps.size() && told; ++k) {
        lost_mps += stretch.step_s * pull_mps2((static_cast<double>(k) - 0.5) * stretch.step_s);
        stretch.speed_mps[k] -= static_cast<float>(lost_mps);
    }
    return stretch;
}

/// The same drive from bend into bend; the yaw rate tells of it, if it is to.
Stretch bent(bool told) {
    auto stretch = leant(even_drive().stretch, LateralInput::cornering, roll_arm_m);
    stretch.yaw_radps.assign(stretch.speed_mps.size(), 0);
    for (std::size_t k = 1; k < stretch.speed_mps.size() && told; ++k) {
        stretch.yaw_radps[k] =
            static_cast<float>(pull_mps2((static_cast<double>(k) - 0.5) * stretch.step_s) /
                               static_cast<double>(stretch.speed_mps[k]));
    }
    return stretch;
}

/// Mean IRI over the last 150 m, over that of the even drive by the same sensors.
double over_even(const Stretch& stretch, const SensorSet& sensors) {
    EstimatorConfig config;
    config.method = Method::smoother;
    config.sensors = sensors;
    const auto iri = [&](const Stretch& drive) {
        const auto run = smoothed_iri(drive, {.vehicle = car()}, config);
        const auto mean = mean_over({{run}, {}}, 80, 230, car());
        return mean.mri_mm_per_m ? *mean.mri_mm_per_m : *mean.hri_mm_per_m;
    };
    return iri(stretch) / iri(even_drive().stretch);
}

constexpr SensorSet of_a_map{.vertical = true, .pitch = true, .yaw = true};
constexpr SensorSet of_both_tracks{.vertical = true, .roll = true, .pitch = true, .yaw = true};

} // namespace

TEST(Braking, IsNotReadAsRoad) {
    EXPECT_NEAR(over_even(braked(true), of_a_map), 1, 0.03);
}

TEST(Braking, WouldBeReadAsRoadIfTheSpeedDidNotTellOfIt) {
    EXPECT_GT(over_even(braked(false), of_a_map), 1.06);
}

TEST(Bends, AreNotReadAsRoad) {
    EXPECT_NEAR(over_even(bent(true), of_both_tracks), 1, 0.03);
}

TEST(Bends, WouldBeReadAsRoadIfTheYawRateDidNotTellOfThem) {
    EXPECT_GT(over_even(bent(false), of_both_tracks), 1.06);
}

} // namespace macadam::testing
