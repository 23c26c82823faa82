#include "estimator/smoother/stretch_record.hpp"

#include "driven_road.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace macadam::testing {
namespace {

const Vehicle& car() {
    static const Vehicle vehicle = two_axle_car({.wheelbase_m = 2.7, .cg_to_front_m = 1.25}, 0);
    return vehicle;
}

/// Smallest standard deviation that a sample of the vertical channel is given.
double vertical_sd(double true_noise_mps2, double iri_mm_per_m) {
    DriveRecipe recipe{.road = {.iri_mm_per_m = iri_mm_per_m}, .car = linear_car_of(car())};
    recipe.length_m = 2800; // 12 windows of 10 s
    recipe.imu.noise_mps2 = true_noise_mps2;
    const auto record = passage_of(driven_road(recipe).stretch, car(), {});
    return std::sqrt(std::ranges::min(record.variance[0]));
}

} // namespace

/// 0.05 m/s2 is what the vehicle states. The tolerance allows for the scatter of windows of 10 s, of
/// which the quietest counts: some 10 %.
TEST(StretchRecord, TakesAnAccelerometerForAsNoisyAsItsHighestFrequenciesShow) {
    ASSERT_EQ(car().imu.noise_mps2, 0.05);
    EXPECT_NEAR(vertical_sd(0.1, 0.8), 0.1, 0.015);
    EXPECT_NEAR(vertical_sd(0.02, 0.8), 0.05, 0.005) << "never less than stated";
}

/// Short waves of a rough road reach the highest frequencies, too. Taken for noise, they would make
/// it read smoother.
TEST(StretchRecord, TakesARoughRoadForNoNoise) {
    EXPECT_LT(vertical_sd(0.05, 3), 0.06);
    EXPECT_LT(vertical_sd(0.05, 6), 0.07);
}

} // namespace macadam::testing
